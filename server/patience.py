"""Work at the start that takes long is told of while it lasts, so that nobody takes it for dead."""

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

import structlog

TOLD_EVERY_S: Final = 5.0

log = structlog.get_logger(__name__)


@contextmanager
def told_of(work: str) -> Iterator[None]:
    """Name the work in the log every few seconds until it is done; short work is not told of."""
    done = threading.Event()

    def tell() -> None:
        began_s = time.monotonic()
        while not done.wait(TOLD_EVERY_S):
            log.info("this takes a while", work=work, seconds=round(time.monotonic() - began_s))

    teller = threading.Thread(target=tell, name="patience", daemon=True)
    teller.start()
    try:
        yield
    finally:
        done.set()
        teller.join()
