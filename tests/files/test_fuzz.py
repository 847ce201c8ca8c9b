"""Some mutated meshes, plans and files of numbers; `make fuzz-files` tries many more."""

import random
from pathlib import Path

import pytest

from tests.files.encodings import SAVED, some_of, text_of
from tests.recordings.fuzz import mutated, tried

for library in ("shapely", "ezdxf", "pyarrow", "h5py", "yaml", "PIL"):
    pytest.importorskip(library)

for library in ("meshoptimizer", "DracoPy", "ifcopenshell"):
    pytest.importorskip(library)

from tests.files.fuzz import columnar, packed, shapes, tried_shape  # noqa: E402

SHAPES = shapes() | packed()
COLUMNAR = columnar()


@pytest.mark.parametrize("name", SHAPES)
def test_mutated_shapes_are_refused_or_right(tmp_path: Path, name: str) -> None:
    (tmp_path / "map.pgm").write_bytes(b"P5 20 10 255\n" + bytes([254] * 150 + [0] * 50))
    shape = SHAPES[name]
    assert tried_shape(tmp_path / name, shape, shape.content) == "accepted"
    for number in range(2 if name == "a.ifc" else 20):
        content = mutated(shape.content, random.Random(f"{name}{number}"))
        tried_shape(tmp_path / name, shape, content)


@pytest.mark.parametrize("name", SHAPES)
def test_a_text_is_read_however_it_is_saved(tmp_path: Path, name: str) -> None:
    (tmp_path / "map.pgm").write_bytes(b"P5 20 10 255\n" + bytes([254] * 150 + [0] * 50))
    shape = SHAPES[name]
    content = text_of(shape.content)
    if content is None or shape.name == "a.ifc":
        return
    for way in some_of(list(SHAPES).index(name), each=6):
        if way != "blank lines" or not name.endswith("dxf"):
            assert tried_shape(tmp_path / name, shape, SAVED[way](content)) == "accepted", way


@pytest.mark.parametrize("name", COLUMNAR)
def test_mutated_columns_are_refused_or_right(tmp_path: Path, name: str) -> None:
    form = COLUMNAR[name]
    assert tried(tmp_path / form.name, form, form.content) == "accepted"
    for number in range(60):
        content = mutated(form.content, random.Random(f"{name}{number}"))
        tried(tmp_path / form.name, form, content)
