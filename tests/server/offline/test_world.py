"""A world without a server: the same inputs make the same files, and changes stand in them."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from esplanade.planning import Scene
from esplanade.recordings import read_crowd
from esplanade.recordings.crowd import Crowd, Track
from esplanade.recordings.writing import WritingError, write_crowd
from esplanade.server import loading
from esplanade.server.loading import LoadingError
from esplanade.server.offline import OfflineWorld
from esplanade.server.offline.world import FLUSH_TICKS

ROOM = Scene.open_space((0.0, 0.0, 20.0, 12.0), walls=[((10.0, 0.0), (10.0, 5.0))])


@pytest.fixture
def room(tmp_path: Path) -> Path:
    path = tmp_path / "room.json"
    path.write_text(ROOM.model_dump_json(exclude_defaults=True))
    return path


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Two people who cross the room, one of them two seconds later."""
    times = np.arange(0.0, 4.01, 0.4)
    tracks = [
        Track("7", times, np.column_stack([2.0 + 1.2 * times, np.full(len(times), 8.0)])),
        Track("8", 2.0 + times, np.column_stack([np.full(len(times), 5.0), 2.0 + 1.1 * times])),
    ]
    path = tmp_path / "people.csv"
    write_crowd(path, Crowd("people", tuple(tracks)), {})
    return path


def notes(path: Path) -> list[tuple[int, str, dict[str, object]]]:
    """Tick, kind and content of every note of a table."""
    found = re.findall(r"^# frame \d+, tick (\d+), (\w+): (.*)$", path.read_text(), re.MULTILINE)
    return [(int(tick), kind, json.loads(text)) for tick, kind, text in found]


def walked(room: Path, out: Path, seed: int) -> bytes:
    with OfflineWorld(room, actors=3, seed=seed) as world:
        world.write(out)
        for _ in range(40):
            world.step()
    return out.read_bytes()


def test_the_same_seed_writes_the_same_file(room: Path, tmp_path: Path) -> None:
    first = walked(room, tmp_path / "a.csv", 5)
    assert first == walked(room, tmp_path / "b.csv", 5)
    assert first != walked(room, tmp_path / "c.csv", 6)


def test_changes_of_parameters_stand_at_their_tick(room: Path, tmp_path: Path) -> None:
    out = tmp_path / "a.csv"
    with OfflineWorld(room, actors=2, seed=1) as world:
        world.write(out, hz=10)
        for tick in range(1, 41):
            world.step()
            if tick == 20:
                world.set_parameters("main/actor-2", speed_mps=0.6)
        with pytest.raises(ValueError, match="main/nobody"):
            world.set_parameters("main/nobody", speed_mps=0.6)
        with pytest.raises(ValueError, match="speed_mps"):
            world.set_parameters(speed_mps=99.0)
    told = notes(out)
    first = next(content for _, kind, content in told if kind == "parameters")
    assert first["usual"]["speed_mps"] == 1.3
    assert set(first["actors"]) == {"main/actor-1", "main/actor-2"}
    later = [(tick, content) for tick, kind, content in told[1:] if kind == "parameters"]
    assert later == [(21, {"actors": {"main/actor-2": {"speed_mps": 0.6}}})]
    assert told[-1][:2] == (40, "end")
    rows = [line.split(",") for line in out.read_text().splitlines() if line[:1].isdigit()]
    assert [int(row[0]) for row in rows[::2]] == list(range(1, 21))
    assert [float(row[1]) for row in rows[::2]] == pytest.approx(np.arange(1, 21) / 10)


def test_the_planning_interval_stands_where_it_holds(room: Path, tmp_path: Path) -> None:
    for given, wanted in (({}, 2), ({"planning_interval": 3}, 3)):
        out = tmp_path / f"{wanted}.csv"
        with OfflineWorld(room, actors=1, seed=1, **given) as world:
            world.write(out)
            world.step()
            world.step()
        told = [(tick, content) for tick, kind, content in notes(out) if kind == "planning"]
        assert told == [(1, {"interval_ticks": wanted})]


def test_recorded_people_walk_their_tracks_among_actors(
    room: Path, recording: Path, tmp_path: Path
) -> None:
    out = tmp_path / "a.sqlite"
    with OfflineWorld(room, people=recording, actors=2, seed=3) as world:
        assert world.people is not None
        world.write(out)
        while world.time_s < world.people.duration_s + 0.5:
            world.step()
        assert world.people.furthest_m < 0.01
        assert sorted(world.people.names.values()) == ["7", "8"]
        assert world.zone.count() == (0, 2)
        numbers = {name: str(avatar) for avatar, name in world.people.names.items()}
    found = {track.id: track for track in read_crowd(out).tracks}
    for track in read_crowd(recording).tracks:
        for t in track.times[1:-1]:
            assert found[numbers[track.id]].at(float(t)) == pytest.approx(
                track.at(float(t)), abs=0.01
            )


def test_people_keep_their_names_in_files_that_begin_after_they_came(
    room: Path, recording: Path, tmp_path: Path
) -> None:
    with OfflineWorld(room, people=recording, actors=0) as world:
        assert world.report is not None
        for _ in range(10):
            world.step()
        assert world.people is not None
        numbers = {name: avatar for avatar, name in world.people.names.items()}
        world.write(tmp_path / "a.csv")
        while world.time_s < 3.0:
            world.step()
    told = [content for _, kind, content in notes(tmp_path / "a.csv") if kind == "avatar"]
    assert {each["recorded"] for each in told} == {"7", "8"}
    assert next(each for each in told if each["id"] == numbers["7"])["recorded"] == "7"


@pytest.mark.parametrize("among", ["a scene", "open ground"])
def test_columns_of_a_recording_are_named_and_it_is_read_once(
    room: Path, recording: Path, monkeypatch: pytest.MonkeyPatch, among: str
) -> None:
    rows = [line for line in recording.read_text().splitlines() if line[:1].isdigit()]
    odd = recording.with_name("odd.csv")
    odd.write_text("\n".join(["was,wann,wo,wie", *rows]))
    read: list[Path] = []

    def noted(path: Path, *given: Any, **more: Any) -> Crowd:
        read.append(path)
        return read_crowd(path, *given, **more)

    monkeypatch.setattr(loading, "read_crowd", noted)
    scene = room if among == "a scene" else None
    with OfflineWorld(scene, people=odd, actors=0, columns="t,id,x,y") as world:
        world.step()
        assert len(world.positions) == 1
    assert read == [odd]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no full disk to try")
def test_a_world_goes_on_where_its_file_cannot(room: Path, tmp_path: Path) -> None:
    full = tmp_path / "full.csv"
    full.symlink_to("/dev/full")
    with OfflineWorld(room, actors=1) as world:
        world.write(full)
        with pytest.raises(WritingError, match="No space left on device"):  # noqa: PT012
            for _ in range(2 * FLUSH_TICKS):
                world.step()
        ended = world.zone.tick
        world.write(tmp_path / "b.csv")
        world.step()
    assert notes(tmp_path / "b.csv")[-1][:2] == (ended + 1, "end")


def test_without_a_scene_the_ground_is_fitted_to_the_people(
    recording: Path, tmp_path: Path
) -> None:
    with OfflineWorld(people=recording, actors=0) as world:
        world.write(tmp_path / "a.txt")
        for _ in range(30):
            world.step()
        assert len(world.positions) == 1
        x0, y0, x1, y1 = world.zone.scene.bounds
    assert (x0, y1) == pytest.approx((0.0, 10.0))
    assert (x1, y0) == pytest.approx((8.8, 0.0))


def test_rates_between_ticks_and_odd_files_are_refused(room: Path, tmp_path: Path) -> None:
    refused = pytest.raises(ValueError, match=r"3 samples a second lie between .* 20, 10, 5, 4")
    with OfflineWorld(room, actors=0) as world, refused:
        world.write(tmp_path / "a.csv", hz=3)
    with pytest.raises(LoadingError, match=r"no\.json"):
        OfflineWorld(tmp_path / "no.json")


def test_variables_of_a_server_change_nothing(room: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ESPLANADE_TICK_RATE", "10")
    monkeypatch.setenv("ESPLANADE_CROWD", "no.csv")
    with OfflineWorld(room, actors=0) as world:
        assert world.zone.tick_s == 0.05


def test_actors_are_planned_as_often_as_is_asked(room: Path) -> None:
    with OfflineWorld(room, actors=3, planning_interval=2) as world:
        world.step()
        assert world.zone.planning_interval == 2
