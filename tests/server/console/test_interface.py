"""Every path of the interface with requests made from its own description, by schemathesis."""

import asyncio
from contextlib import suppress
from typing import Any

import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis.errors import Unsatisfiable
from schemathesis import Case, GenerationMode
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from tests.server.conftest import Serving
from tests.server.console.operators import operator

EXAMPLES = {GenerationMode.POSITIVE: 10, GenerationMode.NEGATIVE: 5}
"""Requests for each path: as they may be, and as they may not."""
ENDLESS = "/live.sse"
"""An answer without end is not asked for."""
CHECKS = [
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_schema_conformance,
]


async def test_every_path_answers_as_its_description_says(serving: Serving) -> None:
    async with serving(actors=2, tick_rate=60) as server:
        anna = await operator(server, "anna", "admin")
        url = f"http://127.0.0.1:{server.private_port}"
        asked = await asyncio.to_thread(_ask_every_path, url, anna.token)
        assert {("GET", "/api/v1/diff"), ("POST", "/api/v1/commands")} <= asked
        assert (await anna.get("/world"))[0] == 200


def _ask_every_path(url: str, token: str) -> set[tuple[str, str]]:
    """Ask each path for a while; returns the paths."""
    headers = {"Authorization": f"Bearer {token}", "X-Esplanade": "1"}
    schema: Any = schemathesis.openapi.from_url(f"{url}/openapi.json", headers=headers)
    asked = set()
    for found in schema.get_all_operations():
        operation = found.ok()
        if operation.path.endswith(ENDLESS):
            continue
        asked.add((operation.method.upper(), operation.path))
        for mode, examples in EXAMPLES.items():
            _ask(operation, mode, examples, url, headers)
    return asked


def _ask(
    operation: Any, mode: GenerationMode, examples: int, url: str, headers: dict[str, str]
) -> None:
    @settings(
        max_examples=examples,
        deadline=None,
        database=None,
        phases=[Phase.explicit, Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(case=operation.as_strategy(generation_mode=mode))
    def ask(case: Case) -> None:
        response = case.call(base_url=url, headers=headers)
        case.validate_response(response, checks=CHECKS)  # type: ignore[list-item]

    with suppress(Unsatisfiable):  # a path without arguments cannot be asked wrongly
        ask()
