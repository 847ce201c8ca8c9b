"""Brakes on operators: a minute, a second, dry runs, dragged sliders."""

from contextlib import suppress
from typing import Any

import pytest

from esplanade.protocol.commands import COMMAND, Command
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import ROLES
from esplanade.server.console.brakes import REMEMBERED, Brakes
from esplanade.server.console.refusals import RefusedError
from tests.server.conftest import Serving
from tests.server.console.operators import operator
from tests.server.http import get


def command(**more: Any) -> Command:
    body = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}}
    return COMMAND.validate_python({**body, **more})


def by(name: str) -> Identity:
    return Identity(account=name, role="tuner", rights=ROLES["tuner"], via="session")


class Trial:
    """Brakes with a clock that is moved by hand."""

    def __init__(self) -> None:
        self.now_s = 100.0
        self.brakes = Brakes(60, lambda: self.now_s)

    def taken(self, tries: int, gap_s: float, name: str = "olga", **more: Any) -> int:
        count = 0
        for _ in range(tries):
            before = self.brakes.refused
            with suppress(RefusedError):
                self.brakes.take(by(name), [command(**more)])
            count += self.brakes.refused == before
            self.now_s += gap_s
        return count


def test_five_within_a_second() -> None:
    trial = Trial()
    assert trial.taken(20, 0.0) == 5
    assert trial.brakes.refused == 15
    trial.now_s += 1.0
    assert trial.taken(20, 0.0) == 5


def test_sixty_within_a_minute() -> None:
    trial = Trial()
    assert trial.taken(120, 0.25) == 60
    trial.now_s += 60.0
    assert trial.taken(1, 0.0) == 1


def test_one_a_second_goes_on_for_ever() -> None:
    assert Trial().taken(300, 1.0) == 300


def test_a_refusal_says_how_long_to_wait() -> None:
    brakes = Brakes(1, lambda: 0.0)
    brakes.take(by("olga"), [command()])
    with pytest.raises(RefusedError) as caught:
        brakes.take(by("olga"), [command()])
    (fault,) = caught.value.faults
    assert (fault.code, fault.arguments) == ("too_many", {"seconds": 60})


def test_accounts_do_not_brake_each_other_and_are_forgotten_in_turn() -> None:
    trial = Trial()
    assert trial.taken(6, 0.0, "olga") == 5
    assert trial.taken(6, 0.0, "oleg") == 5
    for number in range(REMEMBERED):
        assert trial.taken(1, 0.0, f"account-{number}") == 1
    assert trial.taken(6, 0.0, "olga") == 5


def test_dry_runs_take_nothing_from_commands() -> None:
    trial = Trial()
    assert trial.taken(30, 0.0, dry_run=True) == 20
    assert trial.taken(6, 0.0) == 5


def test_a_list_counts_once() -> None:
    brakes = Brakes(60, lambda: 0.0)
    for _ in range(5):
        brakes.take(by("olga"), [command(), command()])
    with pytest.raises(RefusedError):
        brakes.take(by("olga"), [command(), command()])


@pytest.mark.skipif(
    "stream" not in type(command()).model_fields, reason="no command is part of a stream yet"
)
def test_a_dragged_slider_counts_once() -> None:
    trial = Trial()
    assert trial.taken(600, 0.1, stream=True) == 600
    assert trial.taken(5, 0.0) == 5
    trial.now_s += 3.0
    assert trial.taken(25, 0.0, stream=True) == 21


async def test_whoever_sends_too_fast_is_told_when_to_come_again(serving: Serving) -> None:
    async with serving(actors=0, operator_commands=12) as server:
        olga = await operator(server, "olga", "tuner")
        body = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}}
        assert (await olga.send(body))[0] == 200
        status, told = await olga.send(body)
        assert (status, told["faults"][0]["code"]) == (429, "too_many")
        metrics = await get(server.private_port, "/metrics")
        assert b"esplanade_commands_braked_total 1.0" in metrics.body
