"""`esplanade demo`: the demo world with actors, and in a second process a few visitors.

The server runs in this process and owns its signals. A thread waits until people may come in,
says so, and then sends the visitors: real clients over real sockets, ended with the server.
"""

import contextlib
import http.client
import socket
import subprocess
import sys
import threading
from argparse import Namespace
from collections.abc import Callable
from http import HTTPStatus
from pathlib import Path
from typing import Final

from rich.console import Console
from rich.panel import Panel

from esplanade.commandline.errors import CommandError
from esplanade.commandline.recording_settings import READING
from esplanade.commandline.running import imported
from esplanade.opening import with_scene

POLL_S: Final = 0.25
GRACE_S: Final = 2.0
END_LIMIT_S: Final = 5.0


def run(options: Namespace) -> int:
    """Run the demo until the server ends, and return the server's exit code."""
    with_scene(options)
    for port in (options.port, options.private_port):
        if not _is_free(port):
            raise CommandError(
                f"port {port} is taken, perhaps by another world; others can be given by --port "
                "and --private-port"
            )
    visitors = Visitors(options)
    visitors.start()
    try:
        serve: Callable[[Namespace], int] = imported("esplanade.server.cli:run")
        return serve(options)
    finally:
        visitors.end()


class Visitors:
    """A few wandering bots that come when the world is ready and go when it ends."""

    def __init__(self, options: Namespace) -> None:
        self._options = options
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._come, name="visitors", daemon=True)
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Begin to wait for the server, in the background."""
        self._thread.start()

    def end(self) -> None:
        """Send the visitors home, and wait for it."""
        self._ending.set()
        self._thread.join()
        if self._process is None:
            return
        self._process.terminate()
        try:
            self._process.wait(END_LIMIT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _come(self) -> None:
        while not is_ready(self._options.private_port):
            if self._ending.wait(POLL_S):
                return
        _announce(page_address(self._options))
        if not (self._options.visitors or self._replays) or self._ending.is_set():
            return
        self._send()
        while self._process is not None and not self._ending.is_set():
            self._watch(self._process)
            if not (self._replays and self._process.poll() == 0):
                return
            self._send()  # the recording is over, and begins anew

    @property
    def _replays(self) -> bool:
        return getattr(self._options, "crowd", None) is not None

    def _send(self) -> None:
        if self._ending.is_set():
            return
        self._process = subprocess.Popen(
            [sys.executable, "-m", "esplanade", "bots", *bots_arguments(self._options)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            # Not the terminal's group: its Ctrl-C is ours alone, and we send them home.
            process_group=0,
        )

    def _watch(self, process: subprocess.Popen[bytes]) -> None:
        """Say so if the visitors leave before the world ends."""
        while process.poll() is None:
            if self._ending.wait(POLL_S):
                return
        if self._replays and process.poll() == 0:
            return
        if not self._ending.wait(GRACE_S):
            print(
                f"The visitors have left (status {process.returncode}). "
                f"To see why: esplanade bots {' '.join(bots_arguments(self._options))}",
                file=sys.stderr,
            )


def bots_arguments(options: Namespace) -> list[str]:
    certificate = _certificate(options)
    trusted = [] if certificate is None else [f"--trust={certificate}"]
    if (crowd := getattr(options, "crowd", None)) is not None:
        reading = [
            f"--{name}={'yes' if value is True else value}"
            for name in READING
            if (value := getattr(options, name, None)) not in {None, False}
        ]
        return [f"--url={page_address(options)}", *trusted, f"--replay={crowd}", *reading]
    return [
        f"--url={page_address(options)}",
        *trusted,
        f"--count={options.visitors}",
        f"--seed={options.seed}",
        "--duration=0",
    ]


def _is_free(port: int) -> bool:
    """Whether we may listen there; asked first, so that nobody waits for a start in vain."""
    try:
        socket.create_server(("", port)).close()
    except OSError:
        return False
    return True


def is_ready(private_port: int) -> bool:
    """Whether the server says that people may come in."""
    connection = http.client.HTTPConnection("127.0.0.1", private_port, timeout=1.0)
    with contextlib.closing(connection), contextlib.suppress(OSError, http.client.HTTPException):
        connection.request("GET", "/readyz")
        return connection.getresponse().status == HTTPStatus.OK
    return False


def page_address(options: Namespace) -> str:
    """The address of the page for people on this machine."""
    scheme = "http" if _certificate(options) is None else "https"
    return f"{scheme}://localhost:{options.port}"


def _certificate(options: Namespace) -> Path | None:
    """The certificate by which the server will be known, from the command line or a variable."""
    certificate: Path | None = getattr(options, "tls_cert", None)
    return certificate


def _announce(address: str) -> None:
    Console().print(
        Panel.fit(
            f"Esplanade is open:  [bold]{address}[/bold]\n\n"
            "Open this address in a browser, as often as you like. Ctrl-C ends it.",
            padding=(1, 4),
            border_style="green",
        )
    )
