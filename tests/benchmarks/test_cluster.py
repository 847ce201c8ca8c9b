"""The benchmark of a world on several processes: what it works out, and a small run of it."""

import pytest
from benchmarks._scale_check import Compared, print_check
from benchmarks.cluster import Row, crowd, print_growth, sizes


def row(people: int, gateways: int) -> Row:
    """A crowd whose costs are sums of round constants."""
    viewers = min(people, 500 * gateways)
    return Row(
        people=people,
        viewers=viewers,
        gateways=gateways,
        host_ms=1.0 + 0.002 * people,
        gateway_ms=0.5 + 0.01 * viewers / gateways + 0.0001 * people,
        broker_ms=0.3,
        inside_mb_s=1.0,
        shown_hz=20.0,
        late=0.0,
    )


def test_people_grow_first_and_then_gateways() -> None:
    assert sizes([0, 1000, 4000], [1, 2, 4]) == [(0, 1), (1000, 1), (4000, 1), (4000, 2), (4000, 4)]


def test_the_costs_of_a_larger_crowd_follow_from_the_measured_ones(
    capsys: pytest.CaptureFixture[str],
) -> None:
    print_growth([row(people, gateways) for people, gateways in sizes([0, 1000, 4000], [1, 2, 4])])
    told = capsys.readouterr().out
    assert "host: 1.00 ms + 2.00 µs a person" in told
    assert "gateway: 0.50 ms + 10.00 µs a viewer + 0.10 µs a person in the zone" in told
    assert "10000 people at 10 gateways: 21 ms of a tick of 50 for the host" in told
    assert "12 ms for each gateway of 1000" in told


def test_a_model_that_is_off_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    good, off = Compared("bytes", 100.0, 115.0), Compared("cores", 1.0, 0.7)
    assert print_check([good]) == 0
    assert print_check([good, off]) == 1
    assert "off by more than 20%: cores" in capsys.readouterr().out


def test_a_small_crowd_is_measured_in_real_processes() -> None:
    found = crowd(people=30, gateways=1, each=10, seconds=1.0)
    assert (found.people, found.viewers, found.gateways) == (30, 10, 1)
    assert min(found.host_ms, found.gateway_ms, found.broker_ms) > 0.0
    assert found.inside_mb_s > 0.0
    assert found.shown_hz > 0.0
