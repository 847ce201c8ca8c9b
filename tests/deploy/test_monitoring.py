"""The board and the alerts that are shipped name figures that a real server has."""

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any, Final

import pytest
import yaml

from tests.patience import PATIENCE_S
from tests.server.conftest import Serving, room_file, serving, serving_assets
from tests.server.http import get

__all__ = ["room_file", "serving", "serving_assets"]

DEPLOY: Final = Path(__file__).resolve().parents[2] / "deploy"
SERVER: Final = DEPLOY.parent / "server"
BOARD: Final = DEPLOY / "grafana" / "esplanade.json"
RULES: Final = DEPLOY / "prometheus" / "esplanade.rules.yml"
PROMTOOL: Final = shutil.which("promtool")
needs_promtool = pytest.mark.skipif(
    PROMTOOL is None, reason="promtool, a part of Prometheus, is not installed on this machine"
)


def expressions() -> dict[str, str]:
    """Every expression of the board and of the alerts, by who has it."""
    board: dict[str, Any] = json.loads(BOARD.read_text(encoding="utf-8"))
    found = {
        f"board: {panel['title']} {target['refId']}": target["expr"]
        for panel in board["panels"]
        for target in panel["targets"]
    }
    found |= {f"board: {one['name']}": one["expr"] for one in board["annotations"]["list"]}
    rules = yaml.safe_load(RULES.read_text(encoding="utf-8"))
    for group in rules["groups"]:
        found |= {f"alert: {rule['alert']}": rule["expr"] for rule in group["rules"]}
    return found


async def test_every_figure_that_is_named_is_one_of_a_real_server(serving: Serving) -> None:
    async with serving(actors=1) as server:
        answer = await get(server.private_port, "/metrics")
    text = answer.body.decode()
    families = dict(re.findall(r"^# TYPE (\w+) (\w+)$", text, re.MULTILINE))
    known = set(families)
    for name, kind in families.items():
        if kind == "histogram":
            known |= {f"{name}_bucket", f"{name}_sum", f"{name}_count"}
    unknown = {
        who: missing
        for who, expression in expressions().items()
        if (missing := set(re.findall(r"\besplanade_\w+", expression)) - known)
    }
    assert unknown == {}
    assert sum(who.startswith("alert") for who in expressions()) >= 10
    # Rates are of what only grows, and nothing else is.
    for who, expression in expressions().items():
        rated = set(re.findall(r"(?:rate|increase)\((esplanade_\w+)", expression))
        assert all(name.endswith(("_total", "_bucket")) for name in rated), who


def test_alerts_of_a_cluster_name_figures_that_hosts_and_gateways_have() -> None:
    """They are told by several processes; each is named where it is made."""
    rules = yaml.safe_load((DEPLOY / "prometheus" / "esplanade-cluster.rules.yml").read_text())
    text = " ".join(rule["expr"] for group in rules["groups"] for rule in group["rules"])
    folders = (SERVER / name for name in ("host", "gateway", "link", "clustering"))
    sources = [path.read_text() for folder in folders for path in folder.glob("*.py")]
    told = {name for source in sources for name in re.findall(r'"([a-z_]+)",', source)}
    named = set(re.findall(r"\besplanade_(\w+)", text))
    assert len(named) >= 6
    assert {name for name in named if name.removesuffix("_total") not in told} == set()


def test_panels_of_the_board_lie_beside_each_other() -> None:
    board = json.loads(BOARD.read_text(encoding="utf-8"))
    cells: set[tuple[int, int]] = set()
    for panel in board["panels"]:
        at = panel["gridPos"]
        own = {
            (x, y)
            for x in range(at["x"], at["x"] + at["w"])
            for y in range(at["y"], at["y"] + at["h"])
        }
        assert at["x"] + at["w"] <= 24
        assert not own & cells, panel["title"]
        cells |= own
    ids = [panel["id"] for panel in board["panels"]]
    assert len(set(ids)) == len(ids)


@needs_promtool
@pytest.mark.parametrize(
    "call",
    [
        ["check", "rules", "esplanade.rules.yml"],
        ["check", "config", "prometheus.yml"],
        ["test", "rules", "esplanade.rules.test.yml"],
        ["check", "config", "prometheus-cluster.yml"],
        ["test", "rules", "esplanade-cluster.rules.test.yml"],
    ],
    ids=["rules", "config", "tests", "config of a cluster", "tests of a cluster"],
)
def test_prometheus_takes_what_is_shipped(call: list[str]) -> None:
    done = subprocess.run(
        [str(PROMTOOL), *call],
        cwd=DEPLOY / "prometheus",
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


@needs_promtool
def test_expressions_of_the_board_can_be_read(tmp_path: Path) -> None:
    spans = {"$__rate_interval": "1m", "$instance": ".*"}
    rules = []
    for number, expression in enumerate(expressions().values()):
        filled = expression
        for name, value in spans.items():
            filled = filled.replace(name, value)
        rules.append({"record": f"board:{number}", "expr": filled})
    path = tmp_path / "board.yml"
    path.write_text(yaml.safe_dump({"groups": [{"name": "board", "rules": rules}]}))
    done = subprocess.run(
        [str(PROMTOOL), "check", "rules", str(path)],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
