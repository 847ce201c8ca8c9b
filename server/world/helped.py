"""Heavy work in a thread that a second one helps with, for as long as there is some of it."""

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from time import thread_time
from typing import TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")


class _Helped(threading.local):
    """The processor time that others have spent for this thread so far."""

    seconds = 0.0


_helped = _Helped()


def taken_s() -> float:
    """Seconds of processor time of this thread so far, with those of who has helped it."""
    return thread_time() + _helped.seconds


def each_of(derive: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
    """The results for all items, of which a helper makes every second one.

    That is worth it where `derive` holds no interpreter lock. It has to be safe in two threads.
    """
    if len(items) < 2:
        return [derive(each) for each in items]

    def help_() -> tuple[list[Result], float]:
        begun_s = thread_time()
        return [derive(each) for each in items[1::2]], thread_time() - begun_s

    with ThreadPoolExecutor(1, thread_name_prefix="helper") as pool:
        helping = pool.submit(help_)
        own = [derive(each) for each in items[::2]]
        others, seconds = helping.result()
    _helped.seconds += seconds
    found = [*own, *others]
    found[::2], found[1::2] = own, others
    return found
