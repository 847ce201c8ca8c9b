"""A release has one version everywhere, a date over its changes, and refuses what cannot be."""

import shutil
from pathlib import Path

import pytest
from tools.environments import ROOT
from tools.release import (
    PLACES,
    UNRELEASED,
    ReleaseError,
    current_version,
    to_do,
    write_version,
)


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A folder with all files in which a version stands."""
    for name in [*PLACES, "CHANGELOG.md"]:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    return tmp_path


def texts(folder: Path) -> dict[str, str]:
    return {name: (folder / name).read_text() for name in [*PLACES, "CHANGELOG.md"]}


def test_the_project_has_one_version() -> None:
    assert current_version(ROOT)


def test_a_release_changes_the_version_and_the_heading_and_nothing_else(copy: Path) -> None:
    before, old = texts(copy), current_version(copy)
    write_version(copy, "7.1.3", "2031-05-04")
    assert current_version(copy) == "7.1.3"
    after = texts(copy)
    assert f"{UNRELEASED}\n## [7.1.3] - 2031-05-04\n" in after["CHANGELOG.md"]
    undone = after["CHANGELOG.md"].replace("\n## [7.1.3] - 2031-05-04\n", "", 1)
    assert undone == before["CHANGELOG.md"]
    for name in PLACES:
        assert after[name].replace("7.1.3", old, 1) == before[name]


@pytest.mark.parametrize(
    ("version", "why"),
    [
        ("0.0.1", "0.0.1 is not newer than"),
        ("next", "'next' is no version such as 0.2.0"),
        ("1.2", "'1.2' is no version such as 0.2.0"),
    ],
)
def test_what_is_no_new_version_is_refused_and_nothing_written(
    version: str, why: str, copy: Path
) -> None:
    before = texts(copy)
    with pytest.raises(ReleaseError, match=why):
        write_version(copy, version, "2031-05-04")
    assert texts(copy) == before


def test_a_release_of_nothing_is_refused(copy: Path) -> None:
    write_version(copy, "7.1.3", "2031-05-04")
    with pytest.raises(ReleaseError, match="nothing below Unreleased"):
        write_version(copy, "7.1.4", "2031-05-05")


def test_versions_that_differ_are_named(copy: Path) -> None:
    path = copy / "CITATION.cff"
    path.write_text(path.read_text().replace("version: 0", "version: 9"))
    with pytest.raises(ReleaseError, match=r"versions differ: pyproject.toml: .*CITATION.cff: 9"):
        current_version(copy)


def test_what_is_left_names_the_tag_and_the_packages() -> None:
    assert "git tag -a v7.1.3" in to_do("7.1.3")
    assert "dist/esplanade-codec-7.1.3.tgz" in to_do("7.1.3")
