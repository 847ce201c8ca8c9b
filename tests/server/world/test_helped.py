"""Work that two threads share: the same results, and all of its processor time is counted."""

import threading
from time import perf_counter, thread_time

import pytest

from esplanade.server.world.helped import each_of, taken_s


@pytest.mark.parametrize("number", range(5))
def test_results_have_the_order_of_the_items(number: int) -> None:
    threads = set()

    def derive(item: int) -> int:
        threads.add(threading.get_ident())
        return 10 * item

    assert each_of(derive, range(number)) == [10 * item for item in range(number)]
    assert len(threads) == min(number, 2)


def test_the_helpers_processor_time_counts() -> None:
    def busy(seconds: float) -> None:
        until_s = perf_counter() + 60.0
        begun_s = thread_time()
        while thread_time() - begun_s < seconds and perf_counter() < until_s:
            pass

    begun_s, own_s = taken_s(), thread_time()
    each_of(busy, [0.01, 0.05])
    assert thread_time() - own_s < 0.04
    assert taken_s() - begun_s >= 0.06


def test_faults_of_the_helper_are_raised() -> None:
    with pytest.raises(ZeroDivisionError):
        each_of(lambda item: 1 // item, [1, 0])
