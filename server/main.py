"""The server as a process: event loop, signals, and the summary at the end."""

import asyncio
import gc
import signal

import structlog

from esplanade.commandline import interrupts
from esplanade.server import logs
from esplanade.server.app import Running, running
from esplanade.server.entrances import in_url, private_url
from esplanade.server.log_writer import LogWriter
from esplanade.server.settings import ServerSettings

log = structlog.get_logger(__name__)


def serve(settings: ServerSettings) -> None:
    """Run a server until SIGINT or SIGTERM.

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
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, on_signal, number)
        gc.collect()
        gc.freeze()  # the world stays: looking through it for garbage would only hold up ticks
        _announce(settings, server)
        await _offer_first_link(settings, server)
        waiting = asyncio.create_task(stop.wait())
        await asyncio.wait([waiting, server.ticking], return_when=asyncio.FIRST_COMPLETED)
        waiting.cancel()
    for name, zone in server.zones.items():
        log.info("summary", **({"zone": name} if name else {}), **zone.summary())


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
