"""A second process that compiles a part of the kernels into the same cache."""

import contextlib
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

from esplanade.planning.compiled import cache

_CODE: Final = """
import os, sys, threading
sys.path[:] = {path!r}

def end_with_the_other():
    sys.stdin.read()
    os._exit(1)

threading.Thread(target=end_with_the_other, daemon=True).start()
from importlib import import_module
from esplanade.planning.compiled.notice import heard

def one_more():
    sys.stdout.write(".")
    sys.stdout.flush()

with heard(one_more):
    import_module({module!r}).compile_all()
os._exit(0)
"""


def is_complete(name: str) -> bool:
    """Whether an earlier run has compiled all that goes by this name."""
    folder = cache.folder()
    return folder is not None and (folder / f"{name}.complete").exists()


def complete(name: str) -> None:
    """Tell later runs that everything of this name is in the cache."""
    folder = cache.folder()
    if folder is not None:
        with contextlib.suppress(OSError):
            (folder / f"{name}.complete").touch()


@contextmanager
def compiled_beside(module: str, one_more: Callable[[], None]) -> Iterator[Callable[[], None]]:
    """Run `module.compile_all` in a process of its own; yield a function that waits for its end.

    `one_more` is called, in a thread, for each function that it has compiled. Without a cache to
    fill there is no such process. If it fails, its kernels are compiled here when they are called.
    It ends with this process, however this one ends: it reads from a pipe that is closed then.
    """
    if cache.folder() is None:
        yield lambda: None
        return
    with subprocess.Popen(
        [sys.executable, "-c", _CODE.format(path=sys.path, module=module)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # Ctrl-C in the terminal is for this process, which ends the other
    ) as process:

        def read() -> None:
            while process.stdout is not None and process.stdout.read(1):
                one_more()

        def wait() -> None:
            process.wait()

        reader = threading.Thread(target=read, name="kernels", daemon=True)
        reader.start()
        try:
            yield wait
        finally:
            process.kill()
            reader.join()
