"""The ways to the two ports: their addresses in links, and who guards the private one."""

import asyncio
from collections.abc import Callable
from urllib.parse import urlsplit

from esplanade.server.accounts.kept import Kept
from esplanade.server.console.brakes import Brakes
from esplanade.server.console.callers import Callers
from esplanade.server.console.gate import Gate
from esplanade.server.console.origins import Origins
from esplanade.server.net.addresses import TrustedProxies
from esplanade.server.net.tls import Tls
from esplanade.server.options import is_loopback
from esplanade.server.settings import ServerSettings

_EVERYWHERE = frozenset({"0.0.0.0", "::", ""})  # noqa: S104


def private_certificate(settings: ServerSettings, of_people: Tls | None) -> Tls | None:
    """The certificate of the private port; None where it speaks without encryption.

    Raises
    ------
    TlsError
        Its own certificate and key cannot be used.
    """
    if settings.private_tls_cert is not None and settings.private_tls_key is not None:
        return Tls(settings.private_tls_cert, settings.private_tls_key)
    plain = is_loopback(settings.private_host) or settings.behind_proxy
    return None if plain else of_people


def make_gate(
    settings: ServerSettings, kept: Kept, zone: asyncio.AbstractEventLoop, *, encrypted: bool
) -> Gate:
    """The gate of the private port, which may speak TLS itself."""
    names = [*settings.private_names.split(","), settings.private_host]
    proxies = TrustedProxies(settings.trusted_proxies)
    callers = Callers(
        kept.tokens, kept.sessions, Origins(names, encrypted=encrypted), proxies.client_key
    )
    return Gate(
        callers,
        kept,
        zone,
        brakes=Brakes(settings.operator_commands),
        secure_cookies=encrypted or settings.behind_proxy,
    )


def private_url(settings: ServerSettings, port: int) -> str:
    """The address of the private port, for people on this machine."""
    host = settings.private_host
    plain = settings.private_tls_cert is None and (
        is_loopback(host) or settings.behind_proxy or settings.tls_cert is None
    )
    shown = "localhost" if host in _EVERYWHERE else host
    return f"{'http' if plain else 'https'}://{in_url(shown)}:{port}"


def people_url(settings: ServerSettings, port: int) -> Callable[[str], str]:
    """Tells the address of people's port to whoever has reached the private one by a `Host`."""

    def told(host: str) -> str:
        if settings.public_url:
            return settings.public_url
        scheme = "http" if settings.tls_cert is None else "https"
        name = urlsplit(f"//{host}").hostname or "localhost"
        root = settings.root_path.rstrip("/")
        return f"{scheme}://{in_url(name)}:{port}{root}/"

    return told


def in_url(host: str) -> str:
    """A host as it stands in an address: one of IPv6 in brackets."""
    return f"[{host}]" if ":" in host else host
