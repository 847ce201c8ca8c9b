"""The Dockerfile as `tools.image` reads it, and what of the sources comes into an image."""

from pathlib import Path

import pytest
from tools.dockerfile import DockerfileError, health_command, read_dockerfile, words_of
from tools.environments import ROOT
from tools.image import copy_context, in_image


def test_the_stages_of_the_image_are_read_whole() -> None:
    build, last = read_dockerfile(ROOT / "Dockerfile")
    assert (build.name, last.name) == ("build", "")
    assert [step.word for step in last.steps].count("RUN") >= 2
    assert words_of(last.settings["ENTRYPOINT"]) == ["esplanade"]
    assert words_of(last.settings["CMD"]) == ["serve"]
    assert health_command(last.settings["HEALTHCHECK"])[0] == "python"
    (volumes,) = [step.text for step in last.steps if step.word == "VOLUME"]
    assert volumes.split() == ["/home/esplanade/.cache", "/home/esplanade/data"]
    # A command that goes on over lines is one step.
    assert any("&& uv build" in step.text for step in build.steps)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("FROM a\nADD b c\n", "2: 'ADD' is not understood"),
        ("# words\n\nRUN a\n", "3: RUN comes before FROM"),
    ],
)
def test_what_is_not_understood_is_named_by_its_line(tmp_path: Path, text: str, why: str) -> None:
    path = tmp_path / "Dockerfile"
    path.write_text(text)
    with pytest.raises(DockerfileError, match=why):
        read_dockerfile(path)
    with pytest.raises(DockerfileError, match="no command in the form of a list"):
        words_of("esplanade serve")


def test_only_sources_come_into_an_image(tmp_path: Path) -> None:
    assert in_image("server/app.py")
    assert not in_image("tests/test_dockerfile.py")
    copy_context("tools/uv.txt", tmp_path / "tools/uv.txt")
    assert (tmp_path / "tools/uv.txt").read_bytes() == (ROOT / "tools/uv.txt").read_bytes()
    copy_context(".", tmp_path)
    assert (tmp_path / "pyproject.toml").is_file()
    assert not (tmp_path / "docs").exists()
