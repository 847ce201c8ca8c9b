"""OBJ as programs write it: encodings, white space, continued lines, indices, and what is told."""

import codecs

import numpy as np
import pytest

from esplanade.planning.scene.formats.faces import cut
from esplanade.planning.scene.formats.obj import read_obj

SQUARE = "v -5 0 -5\nv 5 0 -5\nv 5 0 5\nv -5 0 5\nf 1 3 2\nf 1 4 3\n"


def area(data: bytes | str) -> float:
    """The area of all triangles, m²."""
    points = cut(read_obj(data if isinstance(data, bytes) else data.encode())).points
    sides = points[:, 1:] - points[:, :1]
    return float(0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum())


@pytest.mark.parametrize(
    "data",
    [
        SQUARE.encode("utf-8-sig"),
        codecs.BOM_UTF8 + SQUARE.encode("utf-8-sig"),
        SQUARE.encode("utf-16"),
        SQUARE.encode("utf-16-le"),
        SQUARE.encode("utf-16-be"),
        codecs.BOM_UTF16_BE + SQUARE.encode("utf-16-be"),
        SQUARE.encode("utf-32"),
        b"o caf\xe9\n" + SQUARE.encode(),
        b"# \xa0\n" + SQUARE.replace(" ", "\xa0").encode("latin-1"),
        SQUARE.replace(" ", "\u3000").encode(),
    ],
)
def test_any_encoding_is_read(data: bytes) -> None:
    assert area(data) == pytest.approx(100.0)


@pytest.mark.parametrize(
    "text",
    [
        SQUARE.replace(" ", "\t"),
        SQUARE.replace(" ", " \t  "),
        SQUARE.replace("\n", "\r\n"),
        SQUARE.replace("\n", "\r"),
        SQUARE.replace("\n", "  \t\n\n"),
        "  " + SQUARE.replace("\n", "\n\t "),
        SQUARE.replace(" ", "\v").replace("\v", "\f", 3),
        SQUARE.replace("\n", " # a remark\n"),
        SQUARE.replace(" 0 ", " \\\n 0 \\ \n"),
        SQUARE.replace("\n", "\r\n").replace("f 1 ", "f 1 \\\r\n"),
        "# made in C:\\models\\\n" + SQUARE,
        SQUARE.rstrip(),
        SQUARE.replace("f 1 3 2", "f -4 -2 -3"),
        SQUARE.replace("f 1 3 2", "f 1/1/1 3//2 2/7"),
        "mtllib absent.mtl\nusemtl brick\ng a b\ns off\nvt 0 0\nvn 0 1 0\n" + SQUARE,
        SQUARE.replace("v -5 0 -5", "v -5 0 -5 1.0 0.5 0.5 0.5"),
        SQUARE.split("f", maxsplit=1)[0] + "f 1 4 3 2\n",
        "\ufeff" + SQUARE + "\ufeff",
    ],
)
def test_any_white_space_and_any_indices_are_read(text: str) -> None:
    assert area(text) == pytest.approx(100.0)


def test_negative_indices_count_from_where_they_stand() -> None:
    second = SQUARE.replace("f 1 3 2\nf 1 4 3", "f -4 -1 -2 -3").replace("v -5", "v 95")
    second = second.replace("v 5", "v 105")
    assert area(SQUARE + second) == pytest.approx(200.0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("v 0 0\n", "line 1: 'v 0 0': a vertex is 'v' and three numbers"),
        ("\nv 0,5 1,0 2,0\n", "line 2: .* three numbers"),
        ("v 0 0 0\nf 1 2 x\n", "line 2: 'x': a corner of a face is a whole number"),
        ("v 0 0 0\n\nf 1 1 9\n", "line 3: the face names corner 9, which is out of bounds"),
        ("v 0 0 0\nf 0 1 1\n", "line 2: the face names corner 0"),
        ("v 0 0 0\nf -2 1 1\n", "line 2: the face names corner -2"),
        ("call other.obj\n", "line 1: 'call' takes in another file"),
        (b"\xff\xfev\0 \0\0", "is not UTF-16 text"),
        (b"\x00\x01\x02" * 90, "no text"),
    ],
)
def test_a_wrong_line_is_named(text: str | bytes, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        area(text)


def test_what_is_passed_over_is_counted() -> None:
    found = cut(read_obj((SQUARE + "f 1 2\nsurf 0 1 0 1 1 2 3\nfoo\nbar\n").encode()))
    assert dict(found.passed) == {
        "faces of fewer than three corners": 1,
        "curves and curved surfaces": 1,
        "lines that are no statement of OBJ, as line 9": 2,
    }
