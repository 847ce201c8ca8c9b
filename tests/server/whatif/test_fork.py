"""A fork is the recorded world until something is changed, and the same world each time."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from esplanade.server.recording.digests import digests
from esplanade.server.recording.reader import Recording
from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.roster import Roster
from esplanade.server.whatif.changes import Changes
from esplanade.server.whatif.errors import WhatIfError
from esplanade.server.whatif.fork import Fork
from esplanade.server.whatif.stretch import Stretch, read_stretch
from esplanade.server.whatif.walkers import RecordedWalkers, Walkers
from esplanade.server.world.state import ACTOR, PERSON
from tests.server.populated import spec
from tests.server.recording.recorded import record

FIRST, LAST = 3, 245


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Recording]:
    path = tmp_path_factory.mktemp("recordings") / "hall.mcap"
    assert record(path) == []
    with Recording(path) as opened:
        yield opened


@pytest.fixture(scope="module")
def replayed(recording: Recording) -> Iterator[ReplayedZone]:
    with ReplayedZone(recording.head) as made:
        yield made


@pytest.fixture(scope="module")
def stretch(recording: Recording, replayed: ReplayedZone) -> Stretch:
    with Recording(recording.path) as opened:
        return read_stretch(opened, replayed, FIRST, LAST)


@pytest.fixture(scope="module")
def as_recorded(recording: Recording, replayed: ReplayedZone) -> list[dict[str, Any]]:
    """The places of everybody and the parts of actors after each tick of the stretch."""
    found: list[dict[str, Any]] = []
    with Recording(recording.path) as opened:
        for second in opened.seconds():
            if second.state is not None and not found:
                replayed.go_to(second.state)
            for tick in second.ticks:
                replayed.step(tick)
                if FIRST < tick.tick <= LAST:
                    found.append(seen(replayed))
    return found


def seen(replayed: ReplayedZone) -> dict[str, Any]:
    zone = replayed.zone
    live = zone.state.live()
    return {
        "places": dict(
            zip(
                zone.state.ids[live].tolist(),
                np.column_stack([zone.state.positions[live], zone.state.heights[live]]).tolist(),
                strict=True,
            )
        ),
        "doors": zone.doors.states(),
        "actors": digests(zone.save_exactly())["actors"],
        "touching": zone.contacts.touching.tolist(),
    }


def run(
    replayed: ReplayedZone,
    stretch: Stretch,
    changes: Changes,
    seed: int | None = None,
    walkers: Walkers | None = None,
) -> list[dict[str, Any]]:
    fork = Fork(replayed, stretch, changes, walkers or RecordedWalkers(stretch), seed)
    return [seen(replayed) for _ in fork.ticks()]


def test_without_a_change_it_is_the_recorded_world_bit_for_bit(
    replayed: ReplayedZone, stretch: Stretch, as_recorded: list[dict[str, Any]]
) -> None:
    assert [tick.tick for tick in stretch.ticks] == list(range(FIRST + 1, LAST + 1))
    assert {plain["kind"] for tick in stretch.ticks for plain in tick.inputs} >= {
        "door_derived",
        "potential_derived",
        "actors_derived",
        "follow",
    }
    assert run(replayed, stretch, Changes()) == as_recorded


def test_another_parameter_makes_another_world_and_the_same_one_again(
    replayed: ReplayedZone, stretch: Stretch, as_recorded: list[dict[str, Any]]
) -> None:
    changes = Changes(values={"speed_mps": 0.6})
    once = run(replayed, stretch, changes)
    assert once[0] != as_recorded[0] or once[5] != as_recorded[5]
    assert run(replayed, stretch, changes) == once
    # The recorded command set the speed as well, and leaves it as it is in the fork.
    zone = replayed.zone
    assert {zone.parameters(str(actor)).speed_mps for actor in zone.actors} == {0.6}
    assert zone.parameters("main/a1").radius_m == 0.4


def test_people_are_where_they_were_whatever_actors_do(
    replayed: ReplayedZone, stretch: Stretch, as_recorded: list[dict[str, Any]]
) -> None:
    people = set(stretch.walked)
    assert len(people) == 2

    def places(found: list[dict[str, Any]]) -> list[Any]:
        return [[tick["places"].get(who) for who in people] for tick in found]

    changes = Changes(values={"speed_mps": 0.6}, doors={"gate": False})
    assert places(run(replayed, stretch, changes)) == places(as_recorded)


def test_a_door_moves_a_quarter_of_a_second_after_it_was_wanted_and_stays(
    replayed: ReplayedZone, stretch: Stretch
) -> None:
    found = run(replayed, stretch, Changes(doors={"gate": False}))
    closed = [not tick["doors"]["gate"] for tick in found]
    # It is wanted in the first tick, and recorded commands that open it again are left out.
    assert closed == [False] * 6 + [True] * (len(found) - 6)


def test_another_body_takes_effect_at_a_fixed_tick(
    replayed: ReplayedZone, stretch: Stretch
) -> None:
    fork = Fork(replayed, stretch, Changes(values={"radius_m": 0.35}), RecordedWalkers(stretch))
    radii = []
    for _ in fork.ticks():
        state = replayed.zone.state
        radii.append(set(state.radii[state.of_kind(ACTOR)].tolist()))
    assert radii == [{0.25}] * 6 + [{0.35}] * (len(radii) - 6)


def test_other_actors_walk_and_people_keep_their_ids(
    replayed: ReplayedZone, stretch: Stretch
) -> None:
    roster = Roster(actors=(spec(7, "wander"), spec(8, "idle")), world={"speed_mps": 1.1})
    fork = Fork(replayed, stretch, Changes({"risk_weight": 20}, roster), RecordedWalkers(stretch))
    for _ in fork.ticks():
        pass
    zone = replayed.zone
    assert sorted(map(str, zone.actors)) == ["main/a7", "main/a8"]
    assert zone.parameters("main/a7").speed_mps == 1.1
    assert zone.parameters("main/a7").risk_weight == 20
    state = zone.state
    assert set(state.ids[state.of_kind(PERSON)].tolist()) == set(stretch.walked)


def test_seeds_draw_anew_what_behaviours_draw(replayed: ReplayedZone, stretch: Stretch) -> None:
    roster = Roster(
        actors=(spec(7, "wander", behaviour={"least_pause_s": 0.1, "most_pause_s": 0.4}),)
    )
    changes = Changes(roster=roster)
    one = run(replayed, stretch, changes, seed=1)
    assert run(replayed, stretch, changes, seed=2) != one
    assert run(replayed, stretch, changes, seed=1) == one


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        (Changes(values={"speed_mps": 2.5}), "max_speed_mps"),
        (
            Changes(roster=Roster(actors=(spec(1, "patrol", behaviour={"stops": ["moon"]}),))),
            "moon",
        ),
    ],
)
def test_what_the_world_refuses_is_refused_before_a_tick(
    replayed: ReplayedZone, stretch: Stretch, changes: Changes, text: str
) -> None:
    with pytest.raises(WhatIfError, match=text):
        Fork(replayed, stretch, changes, RecordedWalkers(stretch))


def test_a_stretch_without_ticks_is_refused(recording: Recording, replayed: ReplayedZone) -> None:
    with Recording(recording.path) as opened, pytest.raises(WhatIfError, match="no tick between"):
        read_stretch(opened, replayed, 245, 245)
