"""Reacting people leave their recorded ways for actors that are in the way, and for no others."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from esplanade.server.recording.head import Built, Head
from esplanade.server.recording.reader import Recording
from esplanade.server.recording.zone_recording import ZoneRecording
from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.roster import Roster
from esplanade.server.whatif.changes import Changes
from esplanade.server.whatif.fork import Fork
from esplanade.server.whatif.reacting_walkers import ReactingWalkers
from esplanade.server.whatif.stretch import Stretch, read_stretch
from esplanade.server.world.inputs import Input, Join, Steer, Still
from tests.server.populated import Populated, spec

TICKS = 160
ROUND = {"stops": ["west", "east"], "pause_s": 0.3}
ANN, BEN = 3, 4


def recorded_world(path: Path) -> None:
    """Two people walk to the east, Ben below the wall's end, among a patrol; there is a pause."""
    world = Populated(
        [
            spec(1, "patrol", behaviour=ROUND, place=(4.0, 5.2, 0.0)),
            spec(2, "idle", place=(6.0, 3.2, 0.0)),
        ],
        outside=True,
    )
    at: dict[int, list[Input]] = {
        2: [Join(0, "Ann", (2.0, 4.2, 0.0)), Join(1, "Ben", (2.0, 2.9, 0.0))],
        8: [Steer(ANN, 1, 0.0, 1.2), Steer(BEN, 1, 0.0, 1.2)],
        **{tick: [Still()] for tick in range(40, 45)},
    }
    built = Built.of(world.zone, "hall", 3, 0.25)
    recording = ZoneRecording(world.zone, Head.of(world.zone, built), path, lambda _: None)
    for tick in range(1, TICKS + 1):
        recording.take(world.frame(*at.get(tick, [])), world.inputs[-1])
    recording.close()
    world.population.close()


@pytest.fixture(scope="module")
def replayed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[ReplayedZone, Stretch]]:
    path = tmp_path_factory.mktemp("recordings") / "hall.mcap"
    recorded_world(path)
    with Recording(path) as recording, ReplayedZone(recording.head) as made:
        yield made, read_stretch(recording, made, 1)


def run(
    replayed: tuple[ReplayedZone, Stretch], changes: Changes
) -> tuple[ReactingWalkers, dict[int, list[Any]]]:
    """The walkers after a run, and where people were in each tick."""
    zone, stretch = replayed[0].zone, replayed[1]
    walkers = ReactingWalkers(stretch, zone, None)
    places: dict[int, list[Any]] = {ANN: [], BEN: []}
    for _ in Fork(replayed[0], stretch, changes, walkers).ticks():
        for who, found in places.items():
            if who in zone.state:
                found.append(zone.state.positions[zone.state.slot(who)].tolist())
    return walkers, places


def recorded(stretch: Stretch, who: int) -> list[Any]:
    return list(stretch.walked[who].places[:, :2].tolist())


def test_nobody_evades_actors_that_walk_as_recorded(
    replayed: tuple[ReplayedZone, Stretch],
) -> None:
    walkers, places = run(replayed, Changes())
    assert places == {who: recorded(replayed[1], who) for who in (ANN, BEN)}
    assert walkers.displacements_m == [0.0, 0.0]
    assert walkers.delays_s == [0.0, 0.0]


def test_who_meets_an_actor_makes_room_and_comes_back(
    replayed: tuple[ReplayedZone, Stretch],
) -> None:
    stands = Roster(actors=(spec(8, "idle", place=(5.0, 4.15, 0.0)),))
    walkers, places = run(replayed, Changes(roster=stands))
    ann, was = np.array(places[ANN]), np.array(recorded(replayed[1], ANN))
    away = np.hypot(*(ann - was).T)
    assert away.max() > 0.2
    assert away[:6].max() == 0.0
    assert away[-1] < 0.5 * away.max()
    nearest_m = np.hypot(*(ann - [5.0, 4.15]).T).min()
    assert nearest_m > 0.2 + np.hypot(*(was - [5.0, 4.15]).T).min()
    assert max(walkers.displacements_m) == pytest.approx(away.max())
    # The same actors make the same people, bit for bit.
    assert run(replayed, Changes(roster=stands))[1] == places


def test_walls_hold_people_who_make_room(replayed: tuple[ReplayedZone, Stretch]) -> None:
    stands = Roster(actors=(spec(8, "idle", place=(6.5, 3.2, 0.0)),))
    _, places = run(replayed, Changes(roster=stands))
    zone = replayed[0].zone
    ben = np.array(places[BEN])
    assert (ben != np.array(recorded(replayed[1], BEN))).any()
    clearances = zone.grid.clearance(ben, np.zeros(len(ben)))
    assert clearances.min() > zone.rules.person_clearance_m - 0.06
