"""Scenes that were made of meshes and plans do not fill the disk."""

import os
import time
from pathlib import Path

import pytest

from esplanade import kept_scenes
from esplanade.kept_scenes import make_room, mark_used

DAY_S = 86_400.0


@pytest.fixture(autouse=True)
def _small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_scenes, "MOST_BYTES", 1000)


def made(scenes: Path, name: str, size: int, age_days: float) -> Path:
    folder = scenes / (16 * name)
    folder.mkdir(parents=True)
    (folder / "hall.json").write_bytes(bytes(size))
    used_s = time.time() - age_days * DAY_S
    os.utime(folder, (used_s, used_s))
    return folder


def test_those_used_longest_ago_make_room_and_old_ones_go(tmp_path: Path) -> None:
    current = made(tmp_path, "a", 300, 0.0)
    recent = made(tmp_path, "b", 600, 1.0)
    older = made(tmp_path, "c", 400, 3.0)
    small = made(tmp_path, "d", 50, 20.0)
    old = made(tmp_path, "e", 0, 31.0)
    assert set(make_room(tmp_path, current)) == {older, old}
    assert sorted(tmp_path.iterdir()) == [current, recent, small]


def test_a_scene_that_is_used_again_is_the_youngest(tmp_path: Path) -> None:
    first, second = made(tmp_path, "a", 600, 3.0), made(tmp_path, "b", 600, 2.0)
    mark_used(first)
    assert make_room(tmp_path, first) == [second]


def test_what_is_used_now_or_not_ours_stays(tmp_path: Path) -> None:
    current, begun = made(tmp_path, "a", 5000, 40.0), made(tmp_path, "b", 5000, 0.01)
    others = tmp_path / "notes"
    others.mkdir()
    os.utime(others, (0.0, 0.0))
    elsewhere = made(tmp_path / "elsewhere", "f", 9, 90.0)
    (tmp_path / ("c" * 16)).symlink_to(elsewhere)
    os.utime(tmp_path / "elsewhere", (0.0, 0.0))
    assert make_room(tmp_path, current) == []
    assert current.exists()
    assert begun.exists()
    assert others.exists()
    assert (elsewhere / "hall.json").exists()


def test_there_may_be_no_folder_at_all(tmp_path: Path) -> None:
    assert make_room(tmp_path / "none", tmp_path / "none" / "a") == []
    mark_used(tmp_path / "none" / "a")
