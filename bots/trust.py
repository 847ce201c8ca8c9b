"""The certificates that clients trust, one context of TLS for all clients of a process.

A context of its own for each would read the machine's certificates anew at each connection.
"""

import ssl
from functools import lru_cache
from pathlib import Path
from typing import Final

HIDDEN_BYTES: Final = 16 * 1024
"""TLS reads ahead of a client; from so much on that the client has not taken it stops reading.

One read of the socket may add some 100 kB to it: the server sees a client that does not read so
much later than without TLS.
"""

_BEGIN: Final = "-----BEGIN CERTIFICATE-----"
_END: Final = "-----END CERTIFICATE-----"


def tls_context(trust: Path | None) -> ssl.SSLContext:
    """The context of clients that trust this certificate only; without one, the machine's.

    Of a chain the first certificate counts. The server's name is not checked then: nobody else has
    the key of exactly this certificate.

    Raises
    ------
    ValueError
        The file holds no certificate, or cannot be read.
    """
    if trust is None:
        return _default_context()
    try:
        return _context_of(trust, trust.stat().st_mtime_ns)
    except (OSError, ValueError) as error:
        fault = (isinstance(error, OSError) and error.strerror) or error
        raise ValueError(f"trust: {trust} cannot be used as a certificate: {fault}") from None


@lru_cache(maxsize=1)
def _default_context() -> ssl.SSLContext:
    return ssl.create_default_context()


@lru_cache(maxsize=8)
def _context_of(trust: Path, _changed_ns: int) -> ssl.SSLContext:
    _, begin, rest = trust.read_text(encoding="ascii", errors="replace").partition(_BEGIN)
    inner, end, _ = rest.partition(_END)
    if not begin or not end:
        raise ValueError("it holds none in PEM form")
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    # A certificate that somebody else has signed is trusted without the one that signed it.
    context.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN
    context.load_verify_locations(cadata=begin + inner + end)
    return context
