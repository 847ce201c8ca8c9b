"""The server as a process: event loop, signals, and the summary at the end."""

import asyncio
import gc
import signal
from typing import Any

import structlog

from esplanade.commandline import interrupts
from esplanade.server import logs
from esplanade.server.app import Running, running
from esplanade.server.entrances import in_url, private_url
from esplanade.server.loading import LoadingError
from esplanade.server.log_writer import LogWriter
from esplanade.server.settings import ServerSettings

log = structlog.get_logger(__name__)


def serve(settings: ServerSettings) -> None:
    """Run a server until SIGINT or SIGTERM; SIGUSR1 has a world's file read anew.

    Raises
    ------
    LoadingError
        The scene or crowd cannot be run.
    TlsError
        The certificate and its key cannot be used.
    StoreError
        What is to be kept cannot be.
    OSError
        A port cannot be had.
    """
    with logs.written(settings) as writer:
        try:
            import uvloop  # noqa: PLC0415
        except ImportError:  # there is none for Windows
            asyncio.run(_serve(settings, writer))
        else:
            uvloop.run(_serve(settings, writer))


async def _serve(settings: ServerSettings, writer: LogWriter) -> None:
    loop = asyncio.get_running_loop()
    stop = asyncio.Event()
    # Until people can come in there is nothing to put in order, but there is a thread that compiles
    # for about a minute and cannot be interrupted: Ctrl-C ends the process at once.
    interrupts.end_quietly()

    def on_signal(number: int) -> None:
        log.info("stopping", signal=signal.Signals(number).name)
        stop.set()
        # A person who asks a second time does not want to wait.
        for each in (signal.SIGINT, signal.SIGTERM):
            loop.remove_signal_handler(each)

    async with running(settings) as server:
        server.metrics.total(
            "log_lines_dropped",
            "Lines of the log that were dropped, because nobody read them in time",
            lambda: writer.dropped,
        )
        reloading = Reloading(server)
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, on_signal, number)
        if settings.world is not None and hasattr(signal, "SIGUSR1"):
            loop.add_signal_handler(signal.SIGUSR1, reloading.begin)
        gc.collect()
        gc.freeze()  # the world stays: looking through it for garbage would only hold up ticks
        _announce(settings, server)
        await _offer_first_link(settings, server)
        waiting = asyncio.create_task(stop.wait())
        either: list[asyncio.Future[Any]] = [waiting, server.ticking]
        await asyncio.wait(either, return_when=asyncio.FIRST_COMPLETED)
        waiting.cancel()
        await reloading.end()
    for name, zone in server.zones.items():
        log.info("summary", **({"zone": name} if name else {}), **zone.summary())


class Reloading:
    """Reads the world anew when it is asked to, once after the other, and says what came of it."""

    def __init__(self, server: Running) -> None:
        self._server = server
        self._running: asyncio.Task[None] | None = None

    def begin(self) -> None:
        """Read the world anew, unless that is under way."""
        if self._running is None or self._running.done():
            self._running = asyncio.create_task(self._reload())

    async def end(self) -> None:
        """Break off what is under way."""
        if self._running is not None:
            self._running.cancel()
            await asyncio.gather(self._running, return_exceptions=True)

    async def _reload(self) -> None:
        log.info("reading the world anew")
        try:
            zones = await self._server.reload()
        except LoadingError as error:
            log.warning("the world stays as it was", fault=str(error))
        except Exception:
            log.exception("the world cannot be read anew")
        else:
            log.info("read the world anew", changed=", ".join(zones) or "nothing")


def _announce(settings: ServerSettings, server: Running) -> None:
    host = "localhost" if settings.host in {"0.0.0.0", "::", ""} else settings.host  # noqa: S104
    scheme = "http" if settings.tls_cert is None else "https"
    root = settings.root_path.rstrip("/")
    log.info(
        "open",
        url=f"{scheme}://{in_url(host)}:{server.port}{root and f'{root}/'}",
        private=private_url(settings, server.private_port),
        scene=", ".join(zone.world.scene.name for zone in server.zones.values()),
        actors=settings.actors,
        seed=settings.seed,
    )


async def _offer_first_link(settings: ServerSettings, server: Running) -> None:
    """Tell who reads the log how the first operator gets in, where there is none yet."""
    token = await server.kept.one_time.first_link()
    if token is not None:
        log.info(
            "no operator yet: this link makes the first one, once, within 10 minutes",
            url=f"{private_url(settings, server.private_port)}/console#first={token}",
        )
