"""Meshes from the web are downloaded whole or refused with a reason."""

import http.server
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from esplanade.cli import main
from esplanade.commandline import exit_codes
from esplanade.commandline.errors import UsageError
from esplanade.scenery import download
from esplanade.scenery.download import local_file
from tests.scenery.worlds import write_building

Told = list[tuple[str, float]]


@pytest.fixture
def site(tmp_path: Path) -> Iterator[str]:
    """The address of a server that serves the files of a folder."""

    class Handler(http.server.SimpleHTTPRequestHandler):
        def __init__(self, *arguments: object) -> None:
            super().__init__(*arguments, directory=tmp_path)  # type: ignore[arg-type]

        def log_message(self, *_: object) -> None:
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    thread.join()
    server.server_close()


def test_a_path_is_a_path(tmp_path: Path) -> None:
    with local_file(str(tmp_path / "a.obj"), lambda *_: None) as path:
        assert path == tmp_path / "a.obj"


def test_an_address_is_downloaded_and_deleted(site: str, tmp_path: Path) -> None:
    (tmp_path / "my house.obj").write_bytes(b"v 0 0 0\n" * 50_000)
    reports: Told = []
    with local_file(f"{site}/my%20house.obj", lambda *what: reports.append(what)) as path:
        assert path.name == "my house.obj"
        assert path.read_bytes() == (tmp_path / "my house.obj").read_bytes()
    assert not path.exists()
    assert reports[-1] == ("downloading my house.obj", 1.0)


def test_a_file_that_is_too_large_is_refused(
    site: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(download, "MAX_BYTES", 2**20)
    (tmp_path / "large.obj").write_bytes(bytes(2**20 + 1))
    with (
        pytest.raises(UsageError, match="larger than 1 MiB"),
        local_file(f"{site}/large.obj", lambda *_: None),
    ):
        pass


@pytest.mark.parametrize(
    ("path", "reason"),
    [("/none.obj", "the server answers 404"), (":1/x.obj", "cannot be downloaded")],
)
def test_an_absent_file_is_refused_with_the_reason(site: str, path: str, reason: str) -> None:
    address = site + path if path.startswith("/") else f"http://127.0.0.1{path}"
    with pytest.raises(UsageError, match=reason), local_file(address, lambda *_: None):
        pass


def test_one_command_makes_a_world_of_an_address(
    site: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    address = f"{site}/{write_building(tmp_path).name}"
    target = tmp_path / "made" / "house.json"
    target.parent.mkdir()
    assert main(["scene", "import", address, "--out", str(target)]) == exit_codes.OK
    assert f"esplanade serve --scene {target}" in capsys.readouterr().out
    assert main(["scene", "check", str(target)]) == exit_codes.OK
    assert main(["scene", "import", f"{site}/no.obj", "--out", str(target)]) == exit_codes.USAGE
    assert "404" in capsys.readouterr().err
