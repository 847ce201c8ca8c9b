"""The path under which people find the world, where a proxy in front does not take it away."""

from dataclasses import replace
from http import HTTPStatus

from websockets.http11 import Request, Response

from esplanade.server.assets import path_of, respond


class RootPath:
    """A path such as `/world`; an empty one, or `/`, is that of a world at the top.

    Requests are understood with the path and without it, so that a proxy may take it away or not.
    """

    def __init__(self, text: str) -> None:
        self.text = text.rstrip("/")

    def enter(self, request: Request) -> Request | Response:
        """The request without the root path, or an answer that sends the client to the page.

        Without the last slash the page would look for its files one level above.
        """
        path = path_of(request)
        if not self.text or not f"{path}/".startswith(f"{self.text}/"):
            return request
        rest = request.path[len(self.text) :]
        if path == self.text:
            to = f"{self.text}/{rest}"
            return respond(HTTPStatus.PERMANENT_REDIRECT, b"", {"Location": to})
        return replace(request, path=rest)
