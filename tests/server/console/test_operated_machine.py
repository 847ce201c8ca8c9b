"""Two operators at random over everything that is kept, with restarts: as a plain model says."""

import asyncio
from collections.abc import Iterator
from contextlib import AsyncExitStack
from typing import Any

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)

from esplanade.protocol.commands import COMMAND, Answer
from esplanade.server.accounts.identity import MACHINE
from esplanade.server.audit.log import AuditLog
from esplanade.server.console import scheduler
from esplanade.server.console.console import Console
from esplanade.server.console.groups import Groups
from esplanade.server.console.preset_folder import read_presets
from esplanade.server.console.presets import Presets
from esplanade.server.console.refusals import RefusedError
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import open_store
from esplanade.server.world.inputs import SetParameters
from tests.server.console.consoles import Clock, Nobody, add_account, tuner
from tests.server.console.operated_model import (
    TAGS,
    USUAL,
    ConflictError,
    Model,
    Numbers,
    Waiting,
    Watching,
    value,
)
from tests.server.populated import Populated, spec

NAMES = ("risk_weight", "speed_mps", "max_speed_mps")
SHIPPED = {one.name: one.values for one in read_presets(None)}
WHO = st.sampled_from(["olga", "oleg"])
SCOPES = st.sampled_from(["world", "group:fast", "group:kind:calm", "actor:main/a2"])
VALUES = st.dictionaries(
    st.sampled_from(NAMES), st.sampled_from([0.5, 1.0, 2.0, 3.0]), min_size=1, max_size=2
) | st.just({"risk_weight": -1.0})
PRESETS = st.sampled_from(["timid", "mine"])
WORLD: list[Populated] = []
"""The world of the test: it is made once, and begins anew with each run of the machine."""


class Operating(RuleBasedStateMachine):
    """A console and the model beside it."""

    @initialize()
    def begin(self) -> None:
        self.world = WORLD[0]
        self.world.frame(SetParameters(0, tuple(TAGS), USUAL))
        self.model, self.clock, self.stack = Model(), Clock(), AsyncExitStack()
        self.heads: dict[str, list[dict[str, float]]] = {}
        self.runner = asyncio.Runner()
        self.runner.run(self._open())

    async def _open(self) -> None:
        self.store = await self.stack.enter_async_context(open_store(Location.of(None)))
        self.directory = await add_account(self.store, "olga", "director")
        await self.directory.add(MACHINE, "oleg", "director", None)
        self.console = await self._console()

    async def _console(self) -> Console:
        audit, presets = AuditLog(self.store, "server"), Presets(read_presets(None))
        found = Console(
            self.world.zone, Nobody(), self.store, audit, presets=presets, clock_us=self.clock
        )
        found.figures.add("crowd", "1", "For this test", lambda: self.model.crowd)
        await found.load_operated()
        return found

    # --- what is done -----------------------------------------------------------------------------

    def send(self, who: str, command: dict[str, Any]) -> Answer | None:
        """Return the answer, or None for a refusal."""

        async def act() -> Answer:
            given = [COMMAND.validate_python(command)]
            sending = asyncio.create_task(self.console.carry_out(tuner(who), given))
            while not sending.done():
                await self._tick()
            return (await sending)[0]

        try:
            return self.runner.run(act())
        except RefusedError:
            return None

    async def _tick(self) -> None:
        self.console.take(self.world.frame(*self.console.drain()))
        await asyncio.sleep(0.001)

    def settle(self) -> None:
        """Let the console and the model do what is due."""

        async def act() -> None:
            await self._tick()
            while self.console.scheduler.busy:
                await self._tick()

        self.runner.run(act())
        self.model.settle(self.clock(), Numbers())

    # --- rules ------------------------------------------------------------------------------------

    @rule(who=WHO, scope=SCOPES, values=VALUES, above=st.none() | st.just(5.0), dry=st.booleans())
    def set_values(
        self, who: str, scope: str, values: dict[str, float], above: float | None, dry: bool
    ) -> None:
        command: dict[str, Any] = {"op": "set_parameters", "scope": scope, "values": values}
        if above is not None:
            command["guard"] = {"figure": "crowd", "above": above}
        wanted = {(scope, name): number for name, number in values.items()}
        answer = self.send(who, {**command, "dry_run": dry})
        assert (answer is not None) is self.model.fits(wanted)
        if answer is not None and not dry:
            assert answer.command is not None
            made = self.model.change(who, wanted, answer.command)
            if above is not None:
                self.model.guards.append(Watching(made, above))
        self.settle()

    @rule(who=WHO, actor=st.sampled_from(sorted(TAGS)), name=st.sampled_from(["calm", "wild"]))
    def put_into_group(self, who: str, actor: str, name: str) -> None:
        wanted = {(f"actor:{actor}", "group:kind"): name}
        command = {"op": "set_group", "group": f"kind:{name}", "actors": [actor]}
        answer = self.send(who, command)
        assert (answer is not None) is self.model.fits(wanted)
        if answer is not None:
            self.model.change(who, wanted, answer.command or 0)
        self.settle()

    @rule(who=WHO, scope=SCOPES, preset=PRESETS)
    def apply_preset(self, who: str, scope: str, preset: str) -> None:
        head = self.model.facts.get((f"preset:{preset}", "preset"))
        values = SHIPPED.get(preset) if head is None else self.heads[preset][head - 1]
        wanted = {(scope, name): number for name, number in (values or {}).items()}
        answer = self.send(who, {"op": "apply_preset", "scope": scope, "preset": preset})
        assert (answer is not None) is (values is not None and self.model.fits(wanted))
        if answer is not None:
            self.model.change(who, wanted, answer.command or 0)
        self.settle()

    @rule(who=WHO, preset=PRESETS, risk_weight=st.sampled_from([1.0, 2.0, 3.0]))
    def save_preset(self, who: str, preset: str, risk_weight: float) -> None:
        values = {"risk_weight": risk_weight}
        answer = self.send(who, {"op": "save_preset", "name": preset, "values": values})
        assert answer is not None
        versions = self.heads.setdefault(
            preset, [dict(SHIPPED.get(preset, {}))][: preset in SHIPPED]
        )
        versions.append(values)
        wanted = {(f"preset:{preset}", "preset"): len(versions)}
        assert answer.after[f"preset:{preset}"]["preset"]["version"] == len(versions)
        self.model.change(who, wanted, answer.command or 0)
        self.settle()

    @rule(who=WHO, preset=PRESETS)
    def delete_preset(self, who: str, preset: str) -> None:
        key = f"preset:{preset}", "preset"
        answer = self.send(who, {"op": "delete_preset", "name": preset})
        assert (answer is not None) is (self.model.facts.get(key) is not None)
        if answer is not None:
            self.model.change(who, {key: None}, answer.command or 0)
        self.settle()

    @rule(who=WHO, which=st.sampled_from(["latest", "undone", "latest_of_all"]))
    def revert(self, who: str, which: str) -> None:
        answer = self.send(who, {"op": "revert", "change": which})
        try:
            made = self.model.revertible(who, which)
        except ConflictError:
            assert answer is None
        else:
            assert answer is not None
            self.model.revert(who, made, answer.command or 0)
        self.settle()

    @rule(
        who=WHO,
        scope=SCOPES,
        values=VALUES,
        after_s=st.sampled_from([10.0, 20.0]),
        again_s=st.none() | st.just(15.0),
    )
    def schedule(
        self, who: str, scope: str, values: dict[str, float], after_s: float, again_s: float | None
    ) -> None:
        command = {"op": "set_parameters", "scope": scope, "values": values}
        given = {"op": "schedule", "commands": [command], "when": {"after_s": after_s}}
        answer = self.send(who, {**given, "again_after_s": again_s})
        assert answer is not None
        ((subject, _),) = answer.after.items()
        name = subject.removeprefix("schedule:")
        self.model.schedules[name] = Waiting(
            name,
            who,
            self.clock() + round(1e6 * after_s),
            None if again_s is None else round(1e6 * again_s),
            {(scope, parameter): number for parameter, number in values.items()},
        )
        # Whatever becomes of it, it is no longer as this change has made it: a conflict, then.
        self.model.change(who, {(subject, "schedule"): name}, answer.command or 0)
        self.settle()

    @rule(who=WHO, seconds=st.sampled_from([11.0, 16.0, 40.0]))
    def time_passes(self, who: str, seconds: float) -> None:
        self.clock.pass_s(seconds)
        self.settle()

    @rule(crowd=st.sampled_from([0.0, 9.0]))
    def people_come_and_go(self, crowd: float) -> None:
        self.model.crowd = crowd
        self.settle()

    @rule(who=WHO)
    def role_changes(self, who: str) -> None:
        is_tuner = who in self.model.may_tune
        role = "viewer" if is_tuner else "director"
        self.runner.run(self.directory.set_role(MACHINE, who, role))
        (self.model.may_tune.discard if is_tuner else self.model.may_tune.add)(who)

    @precondition(lambda self: self.model.made)
    @rule()
    def restart(self) -> None:
        """The console ends, and another goes on from what is kept."""

        async def act() -> None:
            before = self.console
            await before.close()
            self.console = await self._console()
            self.console.state.overrides = before.state.overrides
            self.console.state.groups = Groups.load(before.state.groups.save())
            self.console.changes.load(before.changes.save())

        self.runner.run(act())

    # --- what must hold ---------------------------------------------------------------------------

    @invariant()
    def all_is_as_the_model_says(self) -> None:
        if not hasattr(self, "console"):
            return
        model, state = self.model, self.console.state
        for name, waiting in model.schedules.items():
            found = state.schedules.get(name)
            assert found is not None
            assert found.state == waiting.state, (name, found.faults)
            if waiting.state not in {"waiting", "fired"}:
                model.facts.pop((f"schedule:{name}", "schedule"), None)
        for actor in TAGS:
            parameters = self.world.zone.parameters(actor).model_dump()
            for name in NAMES:
                assert parameters[name] == value(model.facts, actor, name), (actor, name)
            assert state.groups.of(actor).get("kind") == (
                model.facts.get((f"actor:{actor}", "group:kind"))
            )
        for preset in ("timid", "mine"):
            head = state.presets.fact(preset)
            version = None if head is None else head["version"]
            assert version == model.facts.get((f"preset:{preset}", "preset"))
        states = [guard.state for guard in self.console.scheduler.guards]
        assert states == [guard.state for guard in model.guards]

    def teardown(self) -> None:
        if hasattr(self, "console"):
            self.runner.run(self._close())
            self.runner.close()

    async def _close(self) -> None:
        await self.console.close()
        await self.stack.aclose()


@pytest.fixture
def world_of_three() -> Iterator[None]:
    world = Populated([spec(1, tags=["fast"]), spec(2), spec(3)])
    world.frame()
    WORLD.append(world)
    yield
    WORLD.clear()
    world.population.close()


@pytest.mark.usefixtures("world_of_three")
def test_all_is_as_the_model_says(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scheduler, "LOOK_S", 0.0)
    run_state_machine_as_test(
        Operating, settings=settings(max_examples=15, stateful_step_count=15, deadline=None)
    )
