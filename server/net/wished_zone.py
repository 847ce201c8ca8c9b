"""The zone that the address of a WebSocket wishes for."""

from urllib.parse import parse_qs, urlsplit

from websockets.http11 import Request


def wished_zone(request: Request) -> str | None:
    """The zone in the query of a request, `/ws?zone=plaza-2`; None where there is none.

    It is whatever the client has written, and only ever compared with names of zones.
    """
    try:
        query = urlsplit(request.path).query
        return parse_qs(query, max_num_fields=8).get("zone", [None])[0]
    except ValueError:
        return None
