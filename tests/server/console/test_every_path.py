"""Every path of the private port and every command, against every role.

A path or a command without a row here fails: whoever adds one says who may use it.
"""

from collections.abc import Iterable, Iterator
from typing import Any, Final, NamedTuple

import pytest
from fastapi import FastAPI
from fastapi.routing import APIRoute, APIWebSocketRoute
from starlette.routing import BaseRoute, Route, WebSocketRoute

from esplanade.protocol.commands import COMMAND
from esplanade.server.accounts.identity import MACHINE
from esplanade.server.accounts.rights import COMMANDS, ROLES, Right
from esplanade.server.console.callers import SAFE
from esplanade.server.net import private
from tests.server.conftest import Serving
from tests.server.console.browsers import Browser, codes


class Row(NamedTuple):
    """A path of the interface, the right that it needs, and how it may be asked for."""

    right: Right | None
    """None where strangers may use it."""
    query: str = ""
    body: Any = None


PATHS: Final[dict[tuple[str, str], Row]] = {
    ("GET", "/schema"): Row(Right.WATCH),
    ("GET", "/world"): Row(Right.WATCH),
    ("GET", "/zones"): Row(Right.WATCH),
    ("GET", "/actors"): Row(Right.WATCH),
    ("GET", "/actors/{actor_id:path}"): Row(Right.WATCH),
    ("GET", "/people"): Row(Right.WATCH),
    ("GET", "/parameters"): Row(Right.WATCH),
    ("GET", "/map"): Row(Right.WATCH),
    ("GET", "/actors/{actor_id:path}/why"): Row(Right.WATCH),
    ("GET", "/actors/{actor_id:path}/trace"): Row(Right.WATCH),
    ("GET", "/series/names"): Row(Right.WATCH),
    ("GET", "/series"): Row(Right.WATCH),
    ("GET", "/events"): Row(Right.WATCH),
    ("GET", "/heat"): Row(Right.WATCH),
    ("GET", "/presets"): Row(Right.WATCH),
    ("GET", "/presets/{name}"): Row(Right.WATCH),
    ("GET", "/groups"): Row(Right.WATCH),
    ("GET", "/schedules"): Row(Right.WATCH),
    ("GET", "/changes"): Row(Right.WATCH),
    ("GET", "/diff"): Row(Right.WATCH),
    ("GET", "/reports"): Row(Right.MODERATE),
    ("GET", "/bans"): Row(Right.MODERATE),
    ("GET", "/chat"): Row(Right.MODERATE),
    ("GET", "/moderation"): Row(Right.MODERATE),
    ("GET", "/live.sse"): Row(Right.WATCH, query="?channels=none"),
    ("POST", "/commands"): Row(
        Right.PARAMETERS,
        body={"op": "set_parameters", "scope": "world", "values": {"risk_weight": 9}},
    ),
    ("GET", "/audit"): Row(Right.AUDIT),
    ("GET", "/audit/verify"): Row(Right.AUDIT),
    ("POST", "/login"): Row(None),
    ("POST", "/first"): Row(None),
    ("GET", "/me"): Row(Right.WATCH),
    ("POST", "/logout"): Row(Right.WATCH),
    ("POST", "/password"): Row(Right.WATCH, body={"old": "x", "new": "y"}),
    ("POST", "/passes"): Row(Right.WATCH),
    ("GET", "/accounts"): Row(Right.ACCOUNTS),
    ("POST", "/accounts"): Row(Right.ACCOUNTS, body={"name": "new", "role": "viewer"}),
    ("PATCH", "/accounts/{name}"): Row(Right.ACCOUNTS, body={"role": "viewer"}),
    ("DELETE", "/accounts/{name}"): Row(Right.ACCOUNTS),
    ("POST", "/accounts/{name}/tokens"): Row(Right.ACCOUNTS, body={"name": "new"}),
    ("DELETE", "/accounts/{name}/tokens/{token}"): Row(Right.ACCOUNTS),
    ("GET", "/invitations"): Row(Right.MODERATE),
    ("POST", "/invitations"): Row(Right.MODERATE, body={"uses": 1}),
    ("DELETE", "/invitations/{invitation}"): Row(Right.MODERATE),
    ("GET", "/bots"): Row(Right.ACCOUNTS),
    ("POST", "/bots"): Row(Right.ACCOUNTS, body={"name": "new"}),
    ("DELETE", "/bots/{name}"): Row(Right.ACCOUNTS),
}
OPEN: Final = {
    "/healthz", "/readyz", "/metrics", "/openapi.json", "/console", "/console/{rest:path}",
}  # fmt: skip
"""Paths outside the interface, which need no right and change nothing."""
SOCKETS: Final = {"/live": Right.WATCH}
"""WebSockets, which each have a hostile test of their own."""

COMMAND_RIGHTS: Final[dict[str, Right]] = {
    "set_parameters": Right.PARAMETERS,
    "clear_parameters": Right.PARAMETERS,
    "apply_preset": Right.PARAMETERS,
    "save_preset": Right.PRESETS,
    "delete_preset": Right.PRESETS,
    "set_group": Right.BEHAVIOURS,
    "schedule": Right.SCHEDULES,
    "cancel_schedule": Right.SCHEDULES,
    "mark": Right.SCHEDULES,
    "revert": Right.PARAMETERS,
    "set_behaviour": Right.BEHAVIOURS,
    "send_actor": Right.BEHAVIOURS,
    "hold_actor": Right.BEHAVIOURS,
    "add_actors": Right.ACTORS,
    "remove_actors": Right.ACTORS,
    "move_door": Right.DOORS,
    "pace": Right.PACE,
    "record": Right.RECORDINGS,
    "announce": Right.ANNOUNCE,
    "mute": Right.MODERATE,
    "kick": Right.MODERATE,
    "warn": Right.MODERATE,
    "walk_out": Right.MODERATE,
    "ban": Right.MODERATE,
    "unban": Right.MODERATE,
    "hide_line": Right.MODERATE,
    "slow_mode": Right.MODERATE,
    "word_filter": Right.MODERATE,
    "quiet_zone": Right.MODERATE,
    "settle_report": Right.MODERATE,
}
COMMAND_BODIES: Final[dict[str, dict[str, Any]]] = {
    "set_parameters": {"scope": "world", "values": {"risk_weight": 9}},
    "clear_parameters": {"scope": "world"},
    "apply_preset": {"scope": "world", "preset": "timid"},
    "save_preset": {"name": "mine", "values": {"risk_weight": 9}},
    "delete_preset": {"name": "mine"},
    "set_group": {"group": "kind:hurried", "actors": ["actor-1"]},
    "schedule": {"commands": [{"op": "mark", "text": "now"}], "when": {"after_s": 5}},
    "cancel_schedule": {"id": "s1"},
    "mark": {"text": "now"},
    "revert": {},
    "set_behaviour": {"actors": ["actor-1"], "behaviour": {"kind": "idle"}},
    "send_actor": {"actor": "actor-1", "target": [1, 1, 0]},
    "hold_actor": {"actor": "actor-1"},
    "add_actors": {"actors": [{}]},
    "remove_actors": {"actors": ["actor-1"]},
    "move_door": {"door": "lobby", "open": True},
    "pace": {"factor": 2.0},
    "record": {"on": True},
    "announce": {"text": "hear"},
    "mute": {"person": 1, "seconds": 1},
    "kick": {"person": 1},
    "warn": {"person": 1, "text": "softly"},
    "walk_out": {"person": 1},
    "ban": {"name_pattern": "rude*"},
    "unban": {"ban": 1},
    "hide_line": {"line": 1},
    "slow_mode": {"seconds": 5},
    "word_filter": {"words": ["rude"]},
    "quiet_zone": {"name": "hall", "polygon": [[0, 0], [1, 0], [1, 1]]},
    "settle_report": {"report": 1},
}
_ROLES: Final = {
    "viewer": {Right.WATCH},
    "moderator": {Right.WATCH, Right.ANNOUNCE, Right.MODERATE},
    "tuner": {
        *(Right.WATCH, Right.ANNOUNCE, Right.MODERATE, Right.PARAMETERS, Right.BEHAVIOURS),
        *(Right.PRESETS, Right.SCHEDULES, Right.EXPERIMENTS),
    },
    "director": set(Right) - {Right.AUDIT, Right.ACCOUNTS},
    "admin": set(Right),
    "auditor": {Right.WATCH, Right.AUDIT},
}
"""The roles as the documentation has them, apart from the table of the program."""


def _routes(routes: Iterable[BaseRoute]) -> Iterator[BaseRoute]:
    """All routes, those of routers that were included too."""
    for each in routes:
        included = getattr(each, "original_router", None)
        if included is None:
            yield each
        else:
            yield from _routes(included.routes)


@pytest.fixture
def app(monkeypatch: pytest.MonkeyPatch) -> list[FastAPI]:
    """The application of the server that is started next."""
    made: list[FastAPI] = []
    really = private.operators_api

    def noted(*given: Any) -> FastAPI:
        made.append(really(*given))
        return made[0]

    monkeypatch.setattr(private, "operators_api", noted)
    return made


async def test_every_path_has_a_row(serving: Serving, app: list[FastAPI]) -> None:
    async with serving():
        found, others, sockets = set(), set(), set()
        for route in _routes(app[0].routes):
            if isinstance(route, WebSocketRoute | APIWebSocketRoute):
                sockets.add(route.path.removeprefix("/api/v1"))
            elif isinstance(route, APIRoute):
                path = route.path.removeprefix("/api/v1")
                found |= {(method, path) for method in route.methods}
            else:
                assert isinstance(route, Route)
                assert (route.methods or set()) <= SAFE, route.path
                others.add(route.path)
        assert found == set(PATHS)
        assert others == OPEN
        assert sockets == set(SOCKETS)


def test_every_command_has_a_row_and_needs_that_right() -> None:
    mapping = COMMAND.json_schema()["discriminator"]["mapping"]
    assert set(mapping) == set(COMMAND_RIGHTS) == set(COMMAND_BODIES)
    assert {name: COMMANDS[name] for name in COMMAND_RIGHTS} == COMMAND_RIGHTS


def test_roles_are_as_the_documentation_says() -> None:
    assert {name: set(rights) for name, rights in ROLES.items()} == _ROLES


@pytest.mark.parametrize("role", ROLES)
async def test_each_role_may_what_it_may_and_nothing_else(serving: Serving, role: str) -> None:
    async with serving(actors=1) as server:
        await server.kept.directory.add(MACHINE, "owner", "admin", None)
        await server.kept.directory.add(MACHINE, "asker", role, None)
        token = await server.kept.tokens.add(MACHINE, "asker", "script")
        asker = Browser(server.private_port, headers={"Authorization": f"Bearer {token}"})
        for (method, path), row in PATHS.items():
            if row.right is None:
                continue
            filled = path.replace("{actor_id:path}", "actor-1").replace("{token}", "none")
            status, body = await asker.send(
                method, filled.replace("{name}", "nobody") + row.query, row.body
            )
            if row.right in _ROLES[role]:
                assert status not in {401, 403}, (method, path, body)
            else:
                assert (status, codes(body)) == (403, ["forbidden"]), (method, path)
        for op, right in COMMAND_RIGHTS.items():
            command = {"op": op, **COMMAND_BODIES[op], "dry_run": True}
            for sent in (command, [command]):
                status, body = await asker.send("POST", "/commands", sent)
                if right in _ROLES[role]:
                    assert status not in {401, 403}, (op, body)
                else:
                    assert (status, codes(body)) == (403, ["forbidden"]), op


async def test_strangers_get_nothing(serving: Serving) -> None:
    async with serving(actors=1) as server:
        stranger = Browser(server.private_port)
        wrong = Browser(server.private_port, headers={"Authorization": "Bearer esplanade_x"})
        stale = Browser(server.private_port, cookie="x" * 43)
        for (method, path), row in PATHS.items():
            if row.right is None:
                continue
            for asker in (stranger, wrong, stale):
                status, body = await asker.send(method, path, row.body)
                assert (status, codes(body)) == (401, ["unauthorized"]), (method, path)


@pytest.mark.parametrize("right", Right)
async def test_a_token_with_one_right_may_what_needs_it(serving: Serving, right: Right) -> None:
    async with serving(actors=1) as server:
        await server.kept.directory.add(MACHINE, "asker", "admin", None)
        token = await server.kept.tokens.add(MACHINE, "asker", "one", rights=frozenset({right}))
        asker = Browser(server.private_port, headers={"Authorization": f"Bearer {token}"})
        for op, needed in COMMAND_RIGHTS.items():
            command = {"op": op, **COMMAND_BODIES[op], "dry_run": True}
            status, _ = await asker.send("POST", "/commands", command)
            assert (status != 403) == (needed == right), op
