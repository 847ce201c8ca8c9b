"""A served world is measured: a tiny case of every scenario, and the parts that could deceive."""

import json

import numpy as np
import pytest
from benchmarks import live
from benchmarks._live_dialects import DIALECTS, frame
from benchmarks._live_peers import frame_of
from benchmarks._live_servers import colyseus_missing
from benchmarks._live_swarm import Share, shares_of
from benchmarks._live_ticks import STAGES, interpolated
from benchmarks._live_walker import Walker

from esplanade.server.world import stage_times

TINY = (
    *("--people", "6", "--actors", "2", "--bots", "2", "--gallery-actors", "2", "--visitors", "2"),
    *("--idle", "8", "--rounds", "1", "--seconds", "2", "--warm-up", "0.5", "--free"),
)
SWITCHED = b"HTTP/1.1 101 Switching Protocols\r\n\r\n"


class Wire:
    """A transport that keeps what a walker writes."""

    def __init__(self) -> None:
        self.written: list[bytes] = []

    def write(self, data: bytes) -> None:
        self.written.append(data)


def test_every_scenario_tells_its_figures(tmp_path, capsys) -> None:
    file = tmp_path / "figures.json"
    assert live.main(["gallery", "crowd", "idle", "sides", *TINY, "--json", str(file)]) == 0
    told = " ".join(capsys.readouterr().out.split())
    figures = json.loads(file.read_text())
    for name in ("gallery", "crowd", "idle"):
        seen = figures[name]
        assert set(seen["ticks"]["stages_ms"]) == set(STAGES)
        assert 0.0 < seen["ticks"]["p50_ms"] <= seen["ticks"]["p99_ms"]
        assert seen["ticks"]["count"] > 0
        assert seen["processor_us"] > 0.0
    assert figures["gallery"]["bots"]["clients"]["joined"] == 2
    assert figures["crowd"]["bots"]["clients"]["joined"] == 2
    assert figures["crowd"]["sent_per_s"] > 0.0
    assert figures["idle"]["sent_per_s"] == 0.0
    assert figures["idle"]["join_ms"][0] > 0.0
    sides = figures["sides"]
    expected = {"esplanade", "websockets", "bare"}
    if absent := colyseus_missing():
        assert f"skipped: {absent}" in told
    else:
        expected |= {"colyseus"}
    assert set(sides) == expected
    for (seen,) in sides.values():
        assert min(seen["snapshots_per_s"]) > 0.0
        assert seen["sent_per_s"] > 0.0
        assert seen["lost"] == 0
    ours, bare = sides["esplanade"][0], sides["bare"][0]
    assert bare["bytes_a_client_tick"] == round(ours["bytes_a_client_tick"])
    assert "ratio to bare" in told


def test_an_unknown_scenario_is_refused() -> None:
    with pytest.raises(SystemExit, match="'crowds' is no scenario, expected one of gallery, crowd"):
        live.main(["crowds", "--seconds", "1", "--free"])


def test_stages_are_those_of_the_server() -> None:
    assert (*stage_times.STAGES, "write") == STAGES


@pytest.mark.parametrize("piece", [1, 3, 7, 1000])
def test_a_walker_counts_frames_however_they_are_cut(piece) -> None:
    walker = Walker(DIALECTS["esplanade"], "/ws", 0, 100.0)
    wire = Wire()
    walker.connection_made(wire)
    frames = [
        b"\x82\x04\x92\x40ab",  # welcome
        b"\x82\x7e\x00\xc8\x94\x43" + bytes(198),  # a snapshot, its length in two bytes
        b"\x82\x03\x93\x4cc",  # steps
        b"\x89\x02hi",  # a ping
        b"\x82\x03\x94\x43c",  # a snapshot
    ]
    stream = SWITCHED + b"".join(frames)
    for begin in range(0, len(stream), piece):
        walker.data_received(stream[begin : begin + piece])
    assert walker.inside
    assert walker.snapshots == 2
    assert walker.received == sum(map(len, frames))
    assert wire.written[0].startswith(b"GET /ws HTTP/1.1\r\n")
    assert wire.written[-1] == b"\x8a\x82" + bytes(4) + b"hi"


def test_a_server_that_refuses_is_told_of() -> None:
    walker = Walker(DIALECTS["bare"], "/", 0, 100.0)
    walker.connection_made(Wire())
    with pytest.raises(ConnectionError, match="503"):
        walker.data_received(b"HTTP/1.1 503 Busy\r\n\r\n")


def test_walkers_are_dealt_out_once_each() -> None:
    whole = Share("bare", 1, [f"/{k}" for k in range(10)], 5, 100.0, 20.0, 1.0)
    shares = shares_of(whole, 3)
    assert [path for share in shares for path in share.paths] == whole.paths
    assert [share.first for share in shares] == [5, 9, 12]
    assert sum(share.join_rate for share in shares) == pytest.approx(20.0)
    assert len(shares_of(whole, 99)) == 10


@pytest.mark.parametrize("size", [20, 127, 132, 600, 5000])
def test_frames_of_servers_without_a_world_have_the_size_that_is_asked_for(size) -> None:
    made = frame_of(size)
    assert len(made) == size
    walker = Walker(DIALECTS["bare"], "/", 0, 100.0)
    walker.connection_made(Wire())
    walker.data_received(SWITCHED + 3 * made)
    assert walker.snapshots == 3


def test_frames_of_clients_are_masked() -> None:
    assert frame(b"abc") == b"\x82\x83" + bytes(4) + b"abc"


def test_percentiles_are_read_out_of_a_histogram() -> None:
    ticks_ms = np.linspace(0.01, 40.0, 4000)
    bounds = (10.0, 20.0, 30.0, 40.0, float("inf"))
    buckets = [(bound, float((ticks_ms <= bound).sum())) for bound in bounds]
    for percent in (1, 50, 99):
        assert interpolated(buckets, percent) == pytest.approx(0.4 * percent, abs=0.02)
    assert interpolated([(1.0, 0.0), (float("inf"), 5.0)], 50) == 1.0
