"""Digests of what a written file was made of."""

import hashlib
from pathlib import Path

import pytest

from esplanade.commandline.provenance import digest_if_there, digest_of


def test_the_digest_of_a_file_is_that_of_its_bytes(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(b"0,1\n")
    assert digest_of(path) == hashlib.sha256(b"0,1\n").hexdigest()
    assert digest_if_there(path) == digest_of(path)


def test_the_digest_of_a_folder_is_that_of_names_and_bytes(tmp_path: Path) -> None:
    digests = []
    for name, files in (
        ("one", {"b.csv": "1", "a.csv": "2"}),
        ("alike", {"a.csv": "2", "b.csv": "1"}),
        ("hidden", {"a.csv": "2", "b.csv": "1", ".cache": "3"}),
        ("renamed", {"a.csv": "2", "c.csv": "1"}),
        ("changed", {"a.csv": "2", "b.csv": "0"}),
    ):
        folder = tmp_path / name
        (folder / "below").mkdir(parents=True)
        for file, text in files.items():
            (folder / file).write_text(text)
        digests.append(digest_of(folder))
    assert digests[0] == digests[1] == digests[2]
    assert len(set(digests)) == 3


def test_what_is_not_there_has_no_digest(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        digest_of(tmp_path / "absent")
    assert digest_if_there(tmp_path / "absent") == ""
