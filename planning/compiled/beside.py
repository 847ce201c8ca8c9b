"""A second process that compiles a part of the kernels into the same cache."""

import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from esplanade.planning.compiled import cache

_CODE = """
import sys
sys.path[:] = {path!r}
from importlib import import_module
from esplanade.planning.compiled.notice import heard
def done():
    sys.stdout.write(".")
    sys.stdout.flush()
with heard(done):
    import_module({module!r}).compile_all()
"""


def is_complete(name: str) -> bool:
    """Whether all that goes by this name has been compiled by an earlier run."""
    folder = cache.folder()
    return folder is not None and (folder / f"{name}.complete").exists()


def complete(name: str) -> None:
    """Tell later runs that everything is there."""
    folder = cache.folder()
    if folder is not None:
        try:
            (folder / f"{name}.complete").touch()
        except OSError:
            return


@contextmanager
def compiled_beside(module: str, heard: Callable[[], None]) -> Iterator[Callable[[], None]]:
    """Have `module.compile_all` run in a process of its own; yields what waits for its end.

    `heard` is called for each function that it compiled. Without a cache to fill there is no
    process. Should it fail, its kernels are compiled here.
    """
    if cache.folder() is None:
        yield lambda: None
        return
    process = subprocess.Popen(
        [sys.executable, "-c", _CODE.format(path=sys.path, module=module)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # Ctrl-C is ours; we end it
    )
    assert process.stdout is not None
    output = process.stdout

    def read() -> None:
        while output.read(1):
            heard()

    reader = threading.Thread(target=read, name="kernels", daemon=True)
    reader.start()
    try:
        yield lambda: (process.wait(), None)[1]
    finally:
        process.kill()
        process.wait()
        reader.join()
