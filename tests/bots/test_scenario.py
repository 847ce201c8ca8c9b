"""Scenarios of a user's own: what they can do, and what is told when they fail."""

import asyncio
from pathlib import Path

import pytest

from esplanade.bots.load import LoadJob
from esplanade.bots.scenario_file import load_scenario
from esplanade.bots.tally import Tally
from esplanade.protocol.messages import ChatLine, Move, Ping, WalkTo, Watch
from tests.bots.scripted import Person, ScriptedServer, scripted_server, until
from tests.bots.test_cli import finish, run, start

TOUR = """\
from esplanade.bots import Scenario
from helper import GOAL


class Tour(Scenario):
    async def on_join(self):
        self.ticks = 0
        await self.chat(f"I am {self.name} at {self.position[0]:.0f}")
        await self.walk_to(*GOAL)

    async def on_tick(self, tick):
        self.ticks += 1
        if self.ticks == 2:
            await self.move(self.random.uniform(0.0, 1.0), 1.0)
            await self.watch(max(self.others, default=None))
            await self.stop()


class Other(Scenario):
    pass


class Stranger:
    pass


class Slip(Scenario):
    def on_tick(self, tick):
        pass
"""

FAILING = """\
from esplanade.bots import Scenario


class Failing(Scenario):
    async def on_join(self):
        await self.helped()

    async def helped(self):
        if self.index != 1:
            raise LookupError("where is " + "everyone?")


class Wrong(Scenario):
    async def on_tick(self, tick):
        await self.move(0.0, speed=-1.0)
"""


@pytest.fixture
def tour(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "helper.py").write_text("GOAL = (3.0, 4.0)\n")
    path = tmp_path / "tour.py"
    path.write_text(TOUR)
    return path


def job(server: ScriptedServer, scenario: str, count: int = 2) -> LoadJob:
    return LoadJob(server.url, count, 0, 1, 1, 100.0, duration_s=0.0, scenario=scenario)


def heard(person: Person, kind: type) -> int:
    """The number of messages of a kind that a person has sent."""
    return sum(isinstance(message, kind) for message in person.heard)


async def test_a_scenario_walks_talks_and_watches(tour: Path) -> None:
    tally, stop = Tally(), asyncio.Event()
    async with scripted_server() as server:
        running = asyncio.create_task(job(server, f"{tour}:Tour").run(tally, stop))
        await until(
            lambda: (
                len(server.all_people) == 2
                and all(heard(each, Move) == 2 and heard(each, Ping) for each in server.all_people)
            )
        )
        stop.set()
        await running
    for person in server.all_people:
        name = person.hello.name
        said = [message for message in person.heard if isinstance(message, ChatLine)]
        assert [line.text for line in said] == [f"I am {name} at 0"]
        walks = [message for message in person.heard if isinstance(message, WalkTo)]
        assert [(walk.x, walk.y) for walk in walks] == [(3.0, 4.0)]
        assert [move.speed for move in person.heard if isinstance(move, Move)] == [1.0, 0.0]
        assert sum(isinstance(message, Watch) for message in person.heard) == 1
    directions = {
        next(m.direction for m in person.heard if isinstance(m, Move))
        for person in server.all_people
    }
    assert len(directions) == 2
    assert tally.well
    assert tally.pings_sent > 0


async def test_errors_are_told_with_file_and_line_and_the_others_go_on(tmp_path: Path) -> None:
    path = tmp_path / "failing.py"
    path.write_text(FAILING)
    tally, stop = Tally(), asyncio.Event()
    async with scripted_server() as server:
        running = asyncio.create_task(job(server, f"{path}:Failing", 4).run(tally, stop))
        await until(lambda: tally.left == 3 and tally.present == 1)
        stop.set()
        await running
    assert tally.scenario_faults == {"failing.py:10: LookupError: where is everyone?": 3}
    assert not tally.well
    assert tally.lost == 0


async def test_a_command_that_the_protocol_does_not_have_is_the_scenarios_fault(
    tmp_path: Path,
) -> None:
    path = tmp_path / "failing.py"
    path.write_text(FAILING)
    tally = Tally()
    async with scripted_server() as server:
        await job(server, f"{path}:Wrong", 1).run(tally, asyncio.Event())
    ((fault, times),) = tally.scenario_faults.items()
    assert times == 1
    assert fault.startswith("failing.py:15: ValidationError: speed: Input should be greater than")


async def test_the_command_tells_faults_of_a_scenario_once_each(tmp_path: Path) -> None:
    path = tmp_path / "failing.py"
    path.write_text(FAILING)
    async with scripted_server() as server:
        process = await start(
            *("--url", server.url, "--count", "4", "--duration", "2", "--processes", "2"),
            *("--scenario", f"{path}:Failing"),
        )
        code, out, err = await finish(process)
    assert code == 1
    assert "error in the scenario, 3 times: failing.py:10: LookupError: where is everyone?" in err
    assert "Traceback" not in out + err
    assert "4 of 4" in out


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("Tuor", "there is no class Tuor; it has Tour, Other, Slip"),
        ("Stranger", "Stranger is no subclass of esplanade.bots.Scenario"),
        ("Slip", "Slip.on_tick must be `async def`"),
    ],
)
def test_a_class_that_is_no_scenario_is_told(tour: Path, name: str, fault: str) -> None:
    with pytest.raises(ValueError, match=fault):
        load_scenario(f"{tour}:{name}")


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("x = 1\nclass Tour(:\n", "bad.py:2: SyntaxError: "),
        ("x = 1\nx.foo\n", "bad.py:2: AttributeError: 'int' object has no attribute 'foo'"),
        ("import no_such_module_here\n", "bad.py:1: ModuleNotFoundError: No module named"),
        ("raise SystemExit(3)\n", "bad.py:1: SystemExit: 3"),
        ("", "there is no class Tour; it has no scenario"),
    ],
)
def test_a_file_that_does_not_run_is_one_line(
    tmp_path: Path, text: str, fault: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "bad.py").write_text(text)
    assert run(["--scenario", f"{tmp_path / 'bad.py'}:Tour"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("esplanade bots: --scenario: ")
    assert fault in line


@pytest.mark.parametrize("text", ["tour.py", ":Tour", "tour.py:", "tour.py:a b"])
def test_a_place_that_names_no_class_is_told(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["--scenario", text]) == 2
    assert "is no scenario, expected FILE:CLASS like my.py:Tour" in capsys.readouterr().err
