"""The certificate and key of people's port, taken anew when their files change."""

import asyncio
import ssl
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final, NoReturn

import structlog

log = structlog.get_logger(__name__)

POLL_S: Final = 2.0
"""The files are looked at this often."""

HANDSHAKE_S: Final = 15.0
"""A client whose TLS handshake is not done by then is cut off."""


class TlsError(ValueError):
    """A certificate and its key cannot be used; the message names the file and what is wrong."""


_MISMATCHES: Final = {"KEY_VALUES_MISMATCH", "KEY_TYPE_MISMATCH", "NO_CERTIFICATE_ASSIGNED"}
"""OpenSSL's reasons for a key of another pair; the last is for a key of another kind."""


class Tls:
    """The certificate chain and key in two PEM files, for connections that are accepted.

    A new connection uses what was valid when it came. A new pair that cannot be used is logged,
    and the one before stays.

    Raises
    ------
    TlsError
        The files cannot be read, do not fit together, or the key is encrypted.
    """

    def __init__(self, certificate: Path, key: Path) -> None:
        self._certificate = certificate
        self._key = key
        self._seen = self._stamps()
        self.context = _context(certificate, key)
        """For the next connection."""

    def always_newest(self) -> ssl.SSLContext:
        """A context for a server that takes only one, whose handshakes use the newest pair."""
        context = _context(self._certificate, self._key)

        def take_newest(handshake: ssl.SSLObject, _: str | None, __: ssl.SSLContext) -> None:
            handshake.context = self.context

        context.sni_callback = take_newest
        return context

    async def renew(self) -> None:
        """Take the files anew whenever they change, until cancelled."""
        while True:
            await asyncio.sleep(POLL_S)
            await asyncio.to_thread(self.look)

    def look(self) -> None:
        """Take the files anew if they have changed."""
        stamps = self._stamps()
        if stamps == self._seen:
            return
        self._seen = stamps
        try:
            self.context = _context(self._certificate, self._key)
        except TlsError as error:
            # Between the change of one file and that of the other they do not fit together.
            log.warning("new certificate refused, the one before stays", fault=str(error))
        else:
            log.info("certificate renewed", file=str(self._certificate))

    def _stamps(self) -> list[tuple[int, int, int] | None]:
        """Return stamps that differ when a file was written or replaced, also behind a link."""
        return [_stamp(path) for path in (self._certificate, self._key)]


@contextmanager
def renewed(*pairs: Tls | None) -> Iterator[None]:
    """Take certificates anew whenever they change; call it on a running event loop."""
    tasks = [asyncio.create_task(each.renew()) for each in {*pairs} if each is not None]
    try:
        yield
    finally:
        for task in tasks:
            task.cancel()


def _stamp(path: Path) -> tuple[int, int, int] | None:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def _context(certificate: Path, key: Path) -> ssl.SSLContext:
    for name, path in (("tls_cert", certificate), ("tls_key", key)):
        try:
            path.read_bytes()
        except OSError as error:
            raise TlsError(f"{name}: {path}: cannot be read: {error.strerror or error}") from None
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_verify_locations(certificate)
    except ssl.SSLError:
        raise TlsError(f"tls_cert: {certificate}: holds no certificate in PEM form") from None
    context = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
    try:
        context.load_cert_chain(certificate, key, _refuse_password)
    except _EncryptedError:
        raise TlsError(
            f"tls_key: {key}: the key is encrypted; give one without a password, such as "
            "`openssl pkey -in KEY -out PLAIN_KEY` writes"
        ) from None
    except ssl.SSLError as error:
        raise TlsError(_fault(certificate, key, error)) from None
    return context


def _fault(certificate: Path, key: Path, error: ssl.SSLError) -> str:
    # There is no reason where a key is not PEM; the certificate has been read before.
    reason = (error.reason or "").lower().replace("_", " ")
    if error.reason in _MISMATCHES:
        return f"tls_key: {key}: it does not belong to the certificate in {certificate}"
    if not reason:
        return f"tls_key: {key}: holds no private key in PEM form"
    return f"tls_cert, tls_key: {certificate} and {key} cannot be used: {reason}"


class _EncryptedError(Exception):
    """A key asks for a password."""


def _refuse_password() -> NoReturn:
    raise _EncryptedError
