"""One way to open text: marks, UTF-16, gzip, line ends, and a bound on everything."""

import gzip
from pathlib import Path

import pytest

from esplanade.files.content import ContentError, read_content
from esplanade.files.text import decoded, read_text

LINES = "t,id\n0,ä\n"


def write(folder: Path, content: bytes) -> Path:
    path = folder / "text"
    path.write_bytes(content)
    return path


@pytest.mark.parametrize(
    "content",
    [
        LINES.encode(),
        b"\xef\xbb\xbf" + LINES.encode(),
        LINES.encode("utf-16"),
        b"\xfe\xff" + LINES.encode("utf-16-be"),
        ("time,person\n" + "0,1\n" * 40).encode("utf-16-le"),
        ("time,person\n" + "0,1\n" * 40).encode("utf-16-be"),
        LINES.encode("utf-32"),
        LINES.replace("\n", "\r\n").encode(),
        LINES.replace("\n", "\r").encode(),
        gzip.compress(LINES.encode(), mtime=0),
        gzip.compress(LINES[:5].encode(), mtime=0) + gzip.compress(LINES[5:].encode(), mtime=0),
        gzip.compress(LINES.encode("utf-16"), mtime=0),
    ],
)
def test_every_encoding_gives_the_same_lines(tmp_path: Path, content: bytes) -> None:
    text = read_text(write(tmp_path, content))
    assert text in {LINES, "time,person\n" + "0,1\n" * 40}


def test_what_is_no_text_is_refused_with_the_byte() -> None:
    with pytest.raises(ContentError, match=r"is not UTF-8 text \(byte 2, line 1\)"):
        decoded(b"ab\xff")
    with pytest.raises(ContentError, match="is not UTF-16 text"):
        decoded(b"\xff\xfea")


def test_eight_bits_are_read_with_a_word() -> None:
    found = decoded("t;größe\n".encode("cp1252"), eight_bit=True)
    assert found.text == "t;größe\n"
    assert "Windows-1252" in found.remark
    with pytest.raises(ContentError, match="is no text, but bytes"):
        decoded(b"\xff\x00\x01", eight_bit=True)


@pytest.mark.parametrize(
    "content", [gzip.compress(b"abc", mtime=0)[:-3], b"\x1f\x8b\x08\x00nothing here"]
)
def test_damaged_gzip_is_told(tmp_path: Path, content: bytes) -> None:
    with pytest.raises(ContentError, match="its gzip is damaged"):
        read_content(write(tmp_path, content))


def test_nothing_fills_the_memory(tmp_path: Path) -> None:
    with pytest.raises(ContentError, match="has more than 1 MiB"):
        read_content(Path("/dev/zero"), 2**20)
    bomb = gzip.compress(bytes(64 * 2**20))
    with pytest.raises(ContentError, match="unpacks to more than 1 MiB"):
        read_content(write(tmp_path, bomb), 2**20)


@pytest.mark.parametrize("name", [".", "absent"])
def test_what_cannot_be_opened(tmp_path: Path, name: str) -> None:
    with pytest.raises(ContentError, match="cannot be read"):
        read_content(tmp_path / name)
