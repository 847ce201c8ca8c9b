"""Policies from outside drive actors of a served world, and can neither stop nor slow it."""

import asyncio
import math
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np
import pytest
from structlog.testing import capture_logs

from esplanade import cli
from esplanade.server.app import Running, running
from esplanade.server.loading import LoadingError
from esplanade.server.settings import ServerSettings
from tests.patience import COMPILING_PATIENCE_S
from tests.server.populated import HALL
from tests.server.recording.recorded import inputs_of_file

ROOT = Path(__file__).parents[3]
EAST = """
class East:
    def velocity(self, observation):
        return 0.7, 0.0
"""
SLOW = """
import time

class Slow:
    def velocity(self, observation):
        time.sleep(60)
"""
LOUD = """
class Loud:
    def __init__(self, word="none"):
        self.word = word

    def velocity(self, observation):
        raise RuntimeError(f"no way, {self.word}")
"""
WAY = """
import numpy as np

class Way:
    def reset(self, task):
        assert task.walls.shape[1:] == (2, 2)
        self.speed = task.preferred_speed

    def velocity(self, observation):
        for person in observation.people:
            assert np.allclose(person.past[-1], person.position)
        ahead = observation.waypoint - observation.position
        return self.speed * ahead / max(1e-9, np.hypot(*ahead))
"""

CORNERS = """
class Corners:
    def __init__(self):
        self.turn = 0

    def goal(self, observation):
        self.turn += 1
        return (2.0, 2.0) if self.turn % 2 else (4.0, 7.0, 0.0)
"""
FAR = """
class Far:
    def goal(self, observation):
        return 1000.0, 2.0
"""


@pytest.fixture
def settings(tmp_path: Path) -> ServerSettings:
    path = tmp_path / "hall.json"
    path.write_text(HALL.model_dump_json(exclude_defaults=True))
    return ServerSettings(scene=path, actors=2, seed=4, port=0, private_port=0)


def policy(folder: Path, text: str) -> str:
    """The name of a policy with this text."""
    path = folder / "mine.py"
    path.write_text(text)
    return f"{path}:{text.split('class ')[1].partition(':')[0]}"


@asynccontextmanager
async def served(settings: ServerSettings, **more: object) -> AsyncIterator[Running]:
    async with (
        asyncio.timeout(COMPILING_PATIENCE_S),
        running(settings.model_copy(update=more)) as server,
    ):
        yield server


async def until(server: Running, holds: Callable[[], bool]) -> None:
    """Wait until something holds after a tick."""
    while not holds():  # noqa: ASYNC110 - a world has no event for its ticks
        await asyncio.sleep(0.02)
    assert server.world.failures == 0


def place(server: Running, actor: str) -> tuple[float, float]:
    avatar = server.world.avatar_of(actor)
    assert avatar is not None
    return server.world.where(avatar)[:2]


def near(server: Running, corner: tuple[float, float]) -> bool:
    if server.world.avatar_of("main/policy-1") is None:
        return False
    return float(np.hypot(*np.subtract(place(server, "main/policy-1"), corner))) < 0.5


def metric(server: Running, name: str) -> float:
    text = server.metrics.exposition().decode()
    (line,) = [one for one in text.splitlines() if one.startswith(f"esplanade_{name} ")]
    return float(line.split()[1])


async def test_it_makes_its_actors_walk_and_no_others(
    settings: ServerSettings, tmp_path: Path
) -> None:
    driving = {"policy": policy(tmp_path, EAST), "policy_actors": 2}
    async with served(settings, **driving) as server:
        world = server.world
        assert [spec.name for spec in world.actors.values()][-2:] == ["East 1", "East 2"]
        table = world._population.table
        east: set[str] = set()

        def both_have_gone_east() -> bool:
            for actor in ("main/policy-1", "main/policy-2"):
                x, y = table.agents.velocities[table.row(actor)].tolist()
                assert math.hypot(x, y) <= 0.7 + 1e-6
                if x > 0.69 and y == pytest.approx(0.0, abs=0.01):
                    east.add(actor)
            return len(east) == 2

        await until(server, both_have_gone_east)
        assert metric(server, "policy_actors") == 2
        assert metric(server, "policy_faults_total") == 0


async def test_it_reaches_the_goals_of_its_actor(settings: ServerSettings, tmp_path: Path) -> None:
    recordings = tmp_path / "recordings"
    driving = {"policy": policy(tmp_path, WAY), "actors": 0, "record": recordings}
    async with served(settings, **driving) as server:
        await until(server, lambda: server.world.trips >= 2)
        assert metric(server, "policy_faults_total") == 0
    (path,) = recordings.glob("*.mcap")
    steered = [each for each in inputs_of_file(path) if each["kind"] == "steer_actors"]
    speeds = [np.hypot(*each["velocities_mps"][0]) for each in steered]
    assert max(speeds) > 1.0
    assert cli.main(["replay", str(path), "--verify"]) == 0


async def test_a_behaviour_sends_its_actor_which_plans_by_itself(
    settings: ServerSettings, tmp_path: Path
) -> None:
    recordings = tmp_path / "recordings"
    driving = {"policy": policy(tmp_path, CORNERS), "actors": 0, "record": recordings}
    async with served(settings, **driving) as server:
        for corner in ((2.0, 2.0), (4.0, 7.0)):
            await until(server, lambda at=corner: near(server, at))
        assert metric(server, "policy_faults_total") == 0
    (path,) = recordings.glob("*.mcap")
    kinds = [each["kind"] for each in inputs_of_file(path)]
    assert "steer_actors" not in kinds
    assert kinds.count("send_actors") >= 2
    assert cli.main(["replay", str(path), "--verify"]) == 0


async def test_the_example_of_a_behaviour_walks_about(settings: ServerSettings) -> None:
    example = ROOT / "examples" / "policies" / "meet_people.py"
    driving = {"policy": f"{example}:MeetPeople", "policy_options": '{"seed": 3}', "actors": 1}
    async with served(settings, **driving) as server:
        await until(server, lambda: metric(server, "policy_decisions_total") >= 3)
        await until(server, lambda: server.world.trips >= 2)
        assert metric(server, "policy_faults_total") == 0


async def test_a_goal_outside_of_the_scene_is_a_fault(
    settings: ServerSettings, tmp_path: Path
) -> None:
    with capture_logs() as lines:
        async with served(settings, policy=policy(tmp_path, FAR)) as server:
            await until(server, lambda: metric(server, "policy_faults_total") >= 1)
    (line, *_) = [each for each in lines if each["event"] == "a policy failed"]
    assert line["fault"] == "its goal (1000, 2) is outside of the scene"


async def test_one_that_fails_is_named_and_its_actor_stands(
    settings: ServerSettings, tmp_path: Path
) -> None:
    driving = {"policy": policy(tmp_path, LOUD), "policy_options": '{"word": "really"}'}
    with capture_logs() as lines:
        async with served(settings, **driving) as server:
            await until(server, lambda: metric(server, "policy_faults_total") >= 1)
            before = place(server, "main/policy-1")
            tick = server.world.tick
            await until(server, lambda: server.world.tick > tick + 10)
            assert place(server, "main/policy-1") == pytest.approx(before, abs=0.01)
    (line, *_) = [each for each in lines if each["event"] == "a policy failed"]
    assert line["policy"] == "Loud"
    assert line["actor"] == "main/policy-1"
    assert line["fault"] == "RuntimeError: no way, really (mine.py, line 7)"


async def test_one_that_never_answers_holds_up_nothing(
    settings: ServerSettings, tmp_path: Path
) -> None:
    async with served(settings, policy=policy(tmp_path, SLOW)) as server:
        await until(server, lambda: server.world.trips >= 1)  # of those that plan
        await until(server, lambda: metric(server, "policy_faults_total") >= 1)
        assert metric(server, "policy_decisions_total") == 0


async def test_one_that_cannot_be_made_is_said_at_the_start(
    settings: ServerSettings, tmp_path: Path
) -> None:
    missing = f"{tmp_path / 'none.py'}:East"
    with pytest.raises(LoadingError, match=r"--policy .*none\.py"):
        async with served(settings, policy=missing):
            pass


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["--policy", "mine.py"], "'mine.py' is not like my_policy.py:MyPolicy"),
        (["--policy-actors", "3"], "it belongs to --policy, but none is given"),
        (["--policy", "m:P", "--policy-options", "[1]"], "'[1]' is no JSON object"),
        (["--policy", "m:P", "--policy-actors", "17"], "'17' is no whole number from 0 to 16"),
        (["--policy", "tcp://nowhere"], "is not like tcp://127.0.0.1:5555/name"),
    ],
)
def test_what_cannot_be_is_refused(
    words: list[str], why: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        raise SystemExit(cli.main(["serve", *words]))
    assert ended.value.code == 2
    assert why in capsys.readouterr().err
