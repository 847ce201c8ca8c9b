"""Policies from outside: what they see, how they fail, and that no future reaches them."""

import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from esplanade.evaluation.policies import make_policy
from esplanade.evaluation.policies.policy import Policy
from esplanade.evaluation.simulation import EpisodeResult, run_episode
from esplanade.policies import asked
from esplanade.policies.errors import PolicyError
from esplanade.policies.names import digest_of_policy, is_outside, label_of
from esplanade.recordings import Obstacles
from tests.evaluation.worlds import RULES, environment, trip, walk
from tests.patience import PATIENCE_S

EXAMPLES = Path(__file__).parents[3] / "examples" / "policies"
ROBOT = walk("1", 0.0, (0, 0), (10, 0))
FUTURE_M = 7.123456789
"""A coordinate that nothing but the future of a person has."""
OTHER = walk("2", 0.0, (10, 2), (FUTURE_M, 2), (FUTURE_M, 9.0))
LATER = walk("3", 0.0, (21, 2), (FUTURE_M, 2), (FUTURE_M, 9.0))
"""Somebody who is there only after the robot has arrived."""

STRAIGHT = """
import numpy as np

class Mine:
    def reset(self, task):
        self.speed, self.tick_s = task.preferred_speed, task.tick_s
        print("this goes to the standard error")

    def velocity(self, observation):
        offset = observation.waypoint - observation.position
        length = float(np.linalg.norm(offset))
        return offset / max(length, 1e-9) * min(self.speed, length / self.tick_s)

    def explain(self):
        return {"path": [[0.0, 0.0], [1.0, 2.0]], "circles": [[3.0, 4.0, 0.5]]}
"""
FAILS = """
import os, signal, time

class {name}:
    def velocity(self, observation):
        if observation.time_s > 0.45:
            {deed}
        return 1.0, 0.0
"""
THIEF = """
import gc, sys, types
import numpy as np

class Thief:
    def __init__(self, wanted, planted=None):
        self.wanted, self.planted = tuple(wanted), planted

    def velocity(self, observation):
        frame = sys._getframe()
        while frame is not None:
            self.look(list(frame.f_locals.values()), 6)
            frame = frame.f_back
        self.look(sys.argv, 2)
        for kept in gc.get_objects():
            if kept is not self.wanted and not isinstance(kept, types.ModuleType):
                self.look(kept, 2)
        return 1.0, 0.0

    def look(self, value, depth):
        if value is self.wanted or depth == 0:
            return
        if isinstance(value, float) and value == self.wanted[0]:
            raise RuntimeError("here is the future")
        if isinstance(value, str) and self.wanted[1] in value:
            raise RuntimeError("here is the recording")
        if isinstance(value, np.ndarray) and value.dtype.kind == "f":
            if (abs(value - self.wanted[0]) < 1e-12).any():
                raise RuntimeError("here is the future")
        elif isinstance(value, dict):
            self.look(list(value.values()), depth - 1)
        elif isinstance(value, (list, tuple, set)):
            for each in value:
                self.look(each, depth - 1)
"""


@pytest.fixture
def made(tmp_path: Path) -> Iterator[Any]:
    """Makes policies of source code; all end with the test."""
    policies: list[Policy] = []

    def make(source: str, name: str = "Mine", **options: Any) -> Policy:
        file = tmp_path / f"{name.lower()}.py"
        file.write_text(source)
        policies.append(make_policy(f"{file}:{name}", options))
        return policies[-1]

    yield make
    for policy in policies:
        policy.close()


def run(policy: Policy, *people: Any, **place: Any) -> EpisodeResult:
    scene = environment(ROBOT, *people, **place)
    return run_episode(scene, trip(scene.replay), policy, RULES)


def test_a_policy_outside_walks_as_the_same_one_inside_bit_for_bit(made: Any, capfd: Any) -> None:
    hedge = Obstacles(segments=(((5.0, -3.0), (5.0, 1.5)),))
    mine = run(made(STRAIGHT), OTHER, obstacles=hedge)
    ours = run(make_policy("straight"), OTHER, obstacles=hedge)
    np.testing.assert_array_equal(mine.trajectory, ours.trajectory)
    assert mine.score.reached
    assert mine.score.fault == ""
    assert "this goes to the standard error" in capfd.readouterr().err


def test_what_it_sees_is_what_the_interface_says(made: Any) -> None:
    source = """
class Mine:
    def reset(self, task):
        assert task.start.tolist() == [0.0, 0.0] and task.goal.shape == (2,), task
        self.goal = task.goal
        assert task.walls.shape == (1, 2, 2) and task.radius == 0.25, task
        assert task.greatest_speed == 1.7 and task.greatest_acceleration == 2.0, task

    def velocity(self, observation):
        assert len(observation.people) == 1 or observation.time_s > 5.0
        for person in observation.people:
            assert person.radius == 0.25 and person.id == 1, person
            assert person.past.shape[1] == 2 and (person.past[-1] == person.position).all(), person
            assert abs(person.velocity - (person.past[-1] - person.past[-2]) / 0.1).max() < 1e-9
        assert (observation.goal == self.goal).all()
        return 1.0, 0.0
"""
    before = walk("7", -5.0, (10, 2), (-20, 2))
    far = Obstacles(segments=(((0.0, 30.0), (5.0, 30.0)),))
    assert run(made(source), before, obstacles=far).score.fault == ""


def test_it_explains_itself_for_pictures(made: Any) -> None:
    policy = made(STRAIGHT)
    run(policy)
    told = policy.debug_info()
    assert told.path.tolist() == [[0.0, 0.0], [1.0, 2.0]]
    assert told.circles.tolist() == [[3.0, 4.0, 0.5]]


@pytest.mark.parametrize(
    ("deed", "said"),
    [
        ("raise KeyError('gone')", "at 0.5 s: KeyError: 'gone' (mine.py, line 7)"),
        ("os._exit(3)", "at 0.5 s: its process ended with code 3"),
        ("os.kill(os.getpid(), signal.SIGKILL)", "at 0.5 s: its process ended by signal 9"),
        ("return float('nan'), 0.0", "velocity is not 2 finite numbers: [nan, 0.0]"),
        ("return []", "velocity is not 2 finite numbers: []"),
        ("return None", "velocity is not made of 2 numbers: None"),
        ("return 1.0, 2.0, 3.0", "velocity is not made of 2 numbers: [1.0, 2.0, 3.0]"),
        ("return [[1.0, 2.0], [3.0, 4.0]]", "velocity is not 2 finite numbers"),
        ("return 'fast'", "velocity is not made of 2 numbers"),
        ("return {1: 2}", "velocity is not made of 2 numbers"),
        ("return object()", "TypeError"),
        ("raise SystemExit(0)", "SystemExit: 0"),
    ],
)
def test_a_policy_that_fails_ends_its_episode_and_no_other(made: Any, deed: str, said: str) -> None:
    policy = made(FAILS.format(name="Mine", deed=deed))
    for _ in range(2):  # it is begun anew, and fails in the same way
        score = run(policy).score
        assert said in score.fault
        assert not score.reached
        assert score.failed
        assert score.decisions == 6


def test_a_policy_that_never_answers_fails(made: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(asked, "DECIDES_WITHIN_S", 0.5)
    policy = made(FAILS.format(name="Mine", deed="time.sleep(3600)").replace("0.45", "-1"))
    assert run(policy).score.fault == "at 0.0 s: it did not answer within 0.5 s"


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("class Other: pass", "mine.py has no class Mine"),
        ("class Mine: pass", "it has no method velocity(observation)"),
        ("import nothing_of_that_name", "ModuleNotFoundError"),
        ("class Mine", "SyntaxError"),
    ],
)
def test_a_policy_that_cannot_be_made_is_refused_by_name(made: Any, source: str, said: str) -> None:
    with pytest.raises(PolicyError, match=r"mine\.py:Mine: ") as refused:
        made(source).start()
    assert said in str(refused.value)


def test_a_policy_that_looks_everywhere_finds_nothing_of_the_future(made: Any) -> None:
    wanted = [FUTURE_M, "crowd-of-tomorrow"]
    score = run(made(THIEF, "Thief", wanted=wanted), LATER).score
    assert score.fault == ""
    assert score.reached
    planted = made(THIEF, "Thief", wanted=wanted, planted=[FUTURE_M])
    assert "here is the future" in run(planted, LATER).score.fault  # it would have found it
    assert "here is the future" in run(made(THIEF, "Thief", wanted=wanted), OTHER).score.fault


def test_names(tmp_path: Path) -> None:
    assert is_outside("mine.py:Mine")
    assert is_outside("tcp://127.0.0.1:5555")
    assert not is_outside("esplanade")
    assert label_of("folder/mine.py:Mine") == "Mine"
    assert label_of("tcp://127.0.0.1:5555/Node") == "Node"
    assert label_of("tcp://127.0.0.1:5555") == "tcp-5555"
    file = tmp_path / "mine.py"
    file.write_text("a = 1")
    before = digest_of_policy(f"{file}:Mine")
    file.write_text("a = 2")
    assert digest_of_policy(f"{file}:Mine") != before


def test_an_entry_point_offers_a_policy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "foreign.py").write_text(STRAIGHT)
    info = tmp_path / "foreign-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: foreign\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[esplanade.policies]\nforeign = foreign:Mine\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{':'.join(filter(None, sys.path))}")
    policy = make_policy("foreign")
    assert run(policy).score.reached
    policy.close()


@pytest.fixture(params=["mjs", "cpp"])
def listening(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[int]:
    """The example in another language, at a port."""
    source = EXAMPLES / f"make_way.{request.param}"
    tool = {"mjs": "node", "cpp": "g++"}[request.param]
    if shutil.which(tool) is None:
        pytest.skip(f"{tool} is absent")
    command = [tool, str(source)]
    if request.param == "cpp":
        command = [str(tmp_path / "make_way")]
        subprocess.run([tool, "-O1", "-o", *command, str(source)], check=True)
    with subprocess.Popen([*command, "0"], stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        yield int(server.stdout.readline().split()[-1])
        server.kill()
        server.wait(PATIENCE_S)


def test_the_examples_walk_alike_in_every_language(listening: int) -> None:
    python = make_policy(f"{EXAMPLES / 'make_way.py'}:MakeWay")
    other = make_policy(f"tcp://127.0.0.1:{listening}/Other")
    expected, found = run(python, OTHER), run(other, OTHER)
    assert found.score.fault == ""
    np.testing.assert_allclose(found.trajectory, expected.trajectory, atol=1e-9)
    python.close()
    other.close()


def test_nobody_who_listens_is_told_of() -> None:
    with pytest.raises(PolicyError, match="is it started"):
        make_policy("tcp://127.0.0.1:9/Nobody").start()
