"""The files of `deploy/` call commands that there are, with options that there are."""

import shlex
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest
import yaml
from tools.environments import ROOT

from esplanade.cli import parser_of

DEPLOY = ROOT / "deploy"
UNITS = sorted((DEPLOY / "systemd").glob("*.service"))
MANIFESTS = sorted(
    path for path in (DEPLOY / "kustomize").glob("*.yaml") if path.name != "kustomization.yaml"
)
STORE = "postgresql://esplanade@localhost/world"
NAMED = {"$(POD)": "zone-0", "%i": "ash", "/world/town.json": str(ROOT / "scenes/town.json")}


def documents(path: Path) -> list[dict[str, Any]]:
    return [each for each in yaml.safe_load_all(path.read_text()) if each]


def check_command(words: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the command's own parser read a line; it ends the test if it cannot."""
    monkeypatch.setenv("ESPLANADE_STORE", STORE)
    command, *rest = [NAMED.get(word, word) for word in words]
    parser_of(command).parse_args(rest)


@pytest.mark.parametrize("path", UNITS, ids=lambda path: path.name)
def test_units_start_commands_that_there_are(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (line,) = [each for each in path.read_text().splitlines() if each.startswith("ExecStart=")]
    program, *words = shlex.split(line.removeprefix("ExecStart="))
    assert program == "/opt/esplanade/bin/esplanade"
    check_command(words, monkeypatch)


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="there is no systemd here")
def test_systemd_understands_the_units(tmp_path: Path) -> None:
    for path in UNITS:
        text = path.read_text().replace("/opt/esplanade/bin/esplanade", "/bin/true")
        (tmp_path / path.name).write_text(text)
    units = sorted(map(str, tmp_path.iterdir()))
    done = subprocess.run(
        ["systemd-analyze", "verify", "--man=no", *units],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_the_services_of_the_cluster_are_commands_that_there_are(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (cluster,) = documents(DEPLOY / "compose/cluster.yml")
    services = cluster["services"]
    ours = {name: one for name, one in services.items() if one["image"] == "esplanade"}
    assert {one["command"][0] for one in ours.values()} == {"cluster", "zone", "gateway"}
    for name, one in ours.items():
        check_command(one["command"], monkeypatch)
        assert one["read_only"], name
        assert set(one["depends_on"]) <= set(services), name
    environment = ours["zone"]["environment"]
    assert {"ESPLANADE_STORE", "ESPLANADE_NATS"} < environment.keys()
    for volume in (volume for one in ours.values() for volume in one["volumes"]):
        place = volume.partition(":")[0]
        assert place in cluster["volumes"] or (DEPLOY / "compose" / place).is_dir()


def test_kubernetes_gets_files_that_there_are() -> None:
    folder = DEPLOY / "kustomize"
    (kustomization,) = documents(folder / "kustomization.yaml")
    assert sorted(kustomization["resources"]) == [path.name for path in MANIFESTS]
    for each in kustomization["configMapGenerator"]:
        for name in each["files"]:
            assert (folder / name).is_file(), name


@pytest.mark.parametrize("path", MANIFESTS, ids=lambda path: path.name)
def test_manifests_fit_together(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for each in documents(path):
        pods = each.get("spec", {}).get("template", {}).get("spec", {})
        selector = each.get("spec", {}).get("selector", {})
        if pods and selector:
            labels = each["spec"]["template"]["metadata"]["labels"]
            assert selector["matchLabels"].items() <= labels.items()
        for container in pods.get("containers", ()):
            if container["image"] == "esplanade":
                check_command(container["args"], monkeypatch)
            ports = {port.get("name") for port in container.get("ports", ())}
            for probe in ("startupProbe", "readinessProbe", "livenessProbe"):
                port = container.get(probe, {}).get("httpGet", {}).get("port")
                assert port is None or port in ports
            mounted = {mount["name"] for mount in container.get("volumeMounts", ())}
            assert mounted <= {volume["name"] for volume in pods.get("volumes", ())}
