"""The benchmark of outcomes: its worlds are what they say, and its judge finds what is wrong."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from benchmarks import outcomes
from benchmarks._outcome_judge import Judge

from esplanade.actors import ActorParameters, ActorState, InTheWay, Outcome, Reason
from esplanade.planning import Scene, Wall

BODY = ActorParameters()
WALLS = Wall(start=(5.0, 0.0), end=(5.0, 4.0)), Wall(start=(5.0, 6.0), end=(5.0, 10.0))
SCENE = Scene(bounds=(0.0, 0.0, 10.0, 10.0), walls=WALLS)
START, GOAL, DOOR = (2.0, 5.0), (8.0, 5.0), (5.0, 5.0)


def state(outcome: Outcome | None, **fields) -> ActorState:
    usual = ActorState(
        position=GOAL,
        layer=0,
        z_m=0.0,
        velocity=(0.0, 0.0),
        heading=0.0,
        reason=Reason.WAITING,
        goal=None,
        slice_s=0.2,
        way=np.zeros((1, 3)),
        outcome=outcome,
        in_the_way=InTheWay("person", "p"),
    )
    return usual._replace(**fields)


def verdict(ended: ActorState, **people) -> outcomes.Verdict:
    world = outcomes.World(SCENE, people, {"a": START}, {"a": GOAL}, {"a": BODY}, {})
    return outcomes.verdict_on(world, "a", {"a": ended}, 20.0)


@pytest.mark.parametrize(
    ("ended", "people", "fault"),
    [
        (state(Outcome.ARRIVED), {}, ""),
        (state(Outcome.ARRIVED, position=START), {}, "6.00 m away"),
        (state(Outcome.NEAR, position=(7.0, 5.0)), {"p": GOAL}, ""),
        (state(Outcome.NEAR, position=(7.0, 5.0)), {"p": DOOR}, "there is a place at the goal"),
        (state(Outcome.NEAR, position=(4.0, 5.0)), {"p": GOAL}, "it is 4.00 m away"),
        (state(Outcome.BLOCKED, position=START), {"p": (5.0, 4.7), "q": (5.0, 5.4)}, ""),
        (state(Outcome.BLOCKED, position=START), {}, "a way leads there"),
        (state(Outcome.NO_WAY, position=START), {"p": DOOR}, "a way leads there"),
    ],
)
def test_outcomes_that_are_untrue_have_a_fault(ended, people, fault: str) -> None:
    assert verdict(ended, **people).fault == fault


def test_reasons_that_are_untrue_are_told() -> None:
    def told(reason: Reason, speed: float, *people: tuple[float, float]) -> str:
        one = state(None, reason=reason, velocity=(speed, 0.0))
        return outcomes.false_reason("a", {"a": one}, people, 0.25)

    assert told(Reason.MOVING, 1.0) == told(Reason.WAITING, 0.0) == ""
    assert told(Reason.GIVING_WAY, 1.0, (7.0, 5.0)) == ""
    assert told(Reason.MOVING, 0.0) == "MOVING at 0.00 m/s"
    assert told(Reason.WAITING, 1.0) == "WAITING at 1.00 m/s"
    assert "nobody is nearer than 7.0 m" in told(Reason.GIVING_WAY, 1.0, (1.0, 5.0))


def test_worlds_are_joined_or_parted_by_a_wall_and_whoever_is_there_fits() -> None:
    for seed in range(30):
        world = outcomes.random_world(seed)
        assert set(world.starts) == set(world.goals) == set(world.bodies)
        for who, start in world.starts.items():
            assert Judge(world.scene, 0.2).leads(start, start, 0.05), who
        for wall in world.scene.walls:
            assert math.dist(wall.start, wall.end) > 1.0


def test_the_command_tells_what_it_found(tmp_path, capsys, monkeypatch) -> None:
    good = outcomes.Verdict("a", "arrived", 4.0, way=True)
    monkeypatch.setattr(outcomes, "judged", lambda _: [good])
    path = tmp_path / "found.json"
    assert outcomes.main(["--worlds", "2", "--json", str(path)]) == 0
    assert "2 worlds; of trips that a way leads to 100.0 % arrive" in capsys.readouterr().out
    assert [row["world"] for row in json.loads(path.read_text())] == [0, 1]
    monkeypatch.setattr(outcomes, "judged", lambda _: [good, replace(good, fault="no")])
    assert outcomes.main(["--worlds", "1"]) == 1
    assert "world 0: a, arrived: no" in capsys.readouterr().out
