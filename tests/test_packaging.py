"""Packaging: the build hook, the wheel, the source archive, and the container's files."""

import os
import re
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
import yaml
from hatch_build import PAGE, SKIP_VARIABLE, ClientBuildHook
from hatchling.bridge.app import Application
from websockets.datastructures import Headers
from websockets.http11 import Request

from esplanade.cli import COMMANDS
from esplanade.server.assets import CLIENT_ASSETS, Assets
from esplanade.server.settings import ServerSettings

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "src" / "esplanade"
SCENES = (
    "gallery.json",
    "gallery_turned.json",
    "pavilion.json",
    "pavilion.obj",
    "plaza.json",
    "town.json",
)

HOLDERS = ("three.js authors", "The MessagePack Community", "Google LLC")
"""The holders of the code that the web client bundles."""

NPM_THAT_BUILDS = """
import sys
from pathlib import Path
assets = Path(__file__).resolve().parents[1] / "src/esplanade/server/client_assets"
if sys.argv[1:] == ["run", "build"]:
    assets.mkdir(parents=True)
    (assets / "index.html").touch()
"""


def source_files() -> list[Path]:
    """Every module below the package, through the links that make one package of the folders."""
    found = [path for folder in PACKAGE.iterdir() for path in folder.rglob("*.py")]
    return found + list(PACKAGE.glob("*.py"))


def hook(root: Path, npm: str) -> ClientBuildHook:
    """The hook in a project whose npm is the given program."""
    (root / "tools").mkdir()
    (root / "tools" / "npm.py").write_text(npm)
    return ClientBuildHook(str(root), {}, None, None, str(root), "wheel", Application())  # type: ignore[arg-type]


def test_hook_builds_the_client_into_a_wheel(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(SKIP_VARIABLE, raising=False)
    hook(tmp_path, NPM_THAT_BUILDS).initialize("standard", {})
    assert (tmp_path / PAGE).is_file()


def test_hook_leaves_the_client_of_an_editable_install_alone(tmp_path: Path) -> None:
    hook(tmp_path, NPM_THAT_BUILDS).initialize("editable", {})
    assert not (tmp_path / "src").exists()


def test_hook_skips_where_the_variable_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(SKIP_VARIABLE, "1")
    hook(tmp_path, NPM_THAT_BUILDS).initialize("standard", {})
    assert not (tmp_path / "src").exists()
    assert "client is not built" in "".join(capsys.readouterr())


@pytest.mark.parametrize(
    ("npm", "message"),
    [("raise SystemExit(3)", "in client_web ended with status 3"), ("", "left no")],
)
def test_hook_says_what_failed(
    npm: str,
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.delenv(SKIP_VARIABLE, raising=False)
    with pytest.raises(SystemExit):
        hook(tmp_path, npm).initialize("standard", {})
    assert message in "".join(capsys.readouterr())


def build(target: str, folder: Path) -> Path:
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "--target", target, "--directory", folder],
        cwd=ROOT,
        env={**os.environ, SKIP_VARIABLE: "1"},
        check=True,
        capture_output=True,
    )
    (archive,) = folder.iterdir()
    return archive


def test_wheel_carries_every_package_and_the_scenes(tmp_path: Path) -> None:
    with zipfile.ZipFile(build("wheel", tmp_path)) as wheel:
        names = wheel.namelist()
        (metadata,) = (wheel.read(name).decode() for name in names if name.endswith("/METADATA"))
        licences = [wheel.read(name).decode() for name in names if "/licenses/" in name]
    tops = {name.split("/")[0] for name in names if ".dist-info/" not in name}
    assert tops == {"esplanade"}
    sources = {f"esplanade/{path.relative_to(PACKAGE)}" for path in source_files()}
    assert len(sources) > 250
    assert sources <= set(names)
    assert {f"esplanade/scenes/{name}" for name in SCENES} <= set(names)
    assert "esplanade/presets/museum-guide.toml" in names
    assert "esplanade/py.typed" in names
    assert "License-Expression: Apache-2.0 AND BSD-3-Clause AND ISC AND MIT\n" in metadata
    for holder in ("Apache License", *HOLDERS):
        assert any(holder in text for text in licences)
    built = sorted((PACKAGE / "server" / "client_assets").glob("**/*.*"))
    assert {f"esplanade/{path.relative_to(PACKAGE)}" for path in built} <= set(names)


def test_licences_of_the_bundle_are_behind_a_link_in_the_page() -> None:
    if not (CLIENT_ASSETS / "index.html").is_file():
        pytest.fail("the web client is not built; run: make client")
    assets = Assets.load()
    page = assets.answer(Request("/", Headers())).body.decode()
    assert 'href="./licences.txt"' in page
    answer = assets.answer(Request("/licences.txt", Headers()))
    assert answer.headers["Content-Type"] == "text/plain; charset=utf-8"
    text = answer.body.decode()
    assert all(holder in text for holder in HOLDERS)
    assert text == (ROOT / "client_web" / "licences.txt").read_text("utf-8"), (
        "the libraries have changed: cp server/client_assets/licences.txt client_web/licences.txt"
    )


def test_lock_file_names_public_addresses_only() -> None:
    addresses = set(re.findall(r"https?://[^/\"]+", (ROOT / "uv.lock").read_text("utf-8")))
    assert addresses == {"https://files.pythonhosted.org", "https://pypi.org"}


def test_source_archive_can_build_the_client(tmp_path: Path) -> None:
    with tarfile.open(build("sdist", tmp_path)) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    needed = {"hatch_build.py", "tools/npm.py", "client_web/package-lock.json", "LICENSE"}
    assert needed <= names
    assert {f"src/esplanade/{path.relative_to(PACKAGE)}" for path in source_files()} <= names
    assert any(name.startswith("client_web/src/") for name in names)
    assert not any("node_modules" in name or "client_assets" in name for name in names)


def test_container_files_agree_with_the_command_and_its_ports() -> None:
    dockerfile = (ROOT / "Dockerfile").read_text()
    fields = ServerSettings.model_fields
    assert f"EXPOSE {fields['port'].default}\n" in dockerfile
    assert f"http://127.0.0.1:{fields['private_port'].default}/readyz" in dockerfile
    assert re.search(r"^USER (?!root|0)\w+", dockerfile, re.MULTILINE)

    compose = yaml.safe_load((ROOT / "docker-compose.yml").read_text())
    (service,) = compose["services"].values()
    assert service["build"] == "."
    assert service["command"][0] in COMMANDS
    assert service["ports"] == [f"{fields['port'].default}:{fields['port'].default}"]


def test_image_gets_everything_that_the_wheel_is_built_from() -> None:
    admitted = {
        line[1:]
        for line in (ROOT / ".dockerignore").read_text().splitlines()
        if line.startswith("!")
    }
    needed = {
        "pyproject.toml",
        "uv.lock",
        "hatch_build.py",
        "README.md",
        "LICENSE",
        "client_web",
        "tools",
    }
    linked = {path.name for path in PACKAGE.iterdir() if path.is_symlink()}
    assert {*needed, *linked, "src"} <= admitted


def test_scripts_can_be_run() -> None:
    script = ROOT / ".ci" / "run"
    assert os.access(script, os.X_OK)
    assert subprocess.run(["bash", "-n", script], check=False).returncode == 0
    assert yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text())["repos"]
