"""OFF, PLY and STL: n-gons of any shape, white space, byte order, and files cut short."""

import io
import struct
import zipfile
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from esplanade.planning.scene.formats.faces import Faces, Triangles, cut
from esplanade.planning.scene.formats.off import read_off
from esplanade.planning.scene.formats.ply import read_ply
from esplanade.planning.scene.formats.stl import read_stl
from esplanade.planning.scene.formats.threemf import read_3mf
from tests.planning.scene.formats.test_faces import DART, U_SHAPE, area

CORNERS = [(x, y, 0.0) for x, y in [*U_SHAPE, *((20 + x, y) for x, y in DART)]]
FACES = [list(range(8)), list(range(8, 12))]


def filled(found: Faces | Triangles) -> float:
    return area((cut(found) if isinstance(found, Faces) else found).points)


def off_text() -> str:
    lines = ["OFF # a U and a dart", f"{len(CORNERS)} {len(FACES)} 0"]
    lines += [f"{x} {y} {z}" for x, y, z in CORNERS]
    lines += [f"{len(face)} {' '.join(map(str, face))} 255 0 0" for face in FACES]
    return "\n".join(lines) + "\n"


def ply(kind: str) -> bytes:
    order = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}[kind]
    head = (
        f"ply\nformat {kind} 1.0\ncomment made by hand\nelement vertex {len(CORNERS)}\n"
        "property float x\nproperty float y\nproperty double z\nproperty uchar red\n"
        f"element face {len(FACES)}\nproperty uchar shade\n"
        "property list uchar int vertex_indices\nend_header\n"
    ).encode()
    if not order:
        rows = [f"{x} {y} {z} 7" for x, y, z in CORNERS]
        rows += [f"1 {len(face)} {' '.join(map(str, face))}" for face in FACES]
        return head + "\n".join(rows).encode()
    body = b"".join(struct.pack(f"{order}ffdB", x, y, z, 7) for x, y, z in CORNERS)
    for face in FACES:
        body += struct.pack(f"{order}BB{len(face)}i", 1, len(face), *face)
    return head + body


@pytest.mark.parametrize("change", [str, lambda t: t.replace(" ", "\t"), lambda t: "\ufeff" + t])
def test_off_fills_concave_faces(change: Callable[[str], str]) -> None:
    assert filled(read_off(change(off_text()).encode())) == pytest.approx(100.0)


@pytest.mark.parametrize("kind", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_ply_fills_concave_faces_of_any_number_of_corners(kind: str) -> None:
    assert filled(read_ply(ply(kind))) == pytest.approx(100.0)
    with pytest.raises(ValueError, match="it ends within"):
        read_ply(ply(kind)[:-2])


def test_ply_refuses_lists_of_less_than_nothing() -> None:
    head = (
        "ply\nformat {} 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nelement face {}\nproperty list char int vertex_indices\nend_header\n"
    )
    negative = struct.pack("<b", -1)
    whole = struct.pack("<b3i", 3, 0, 0, 0)
    for kind, faces, body in (
        ("ascii", 2, b"0 0 0 -2 3 0 0 0"),
        ("binary_little_endian", 1, bytes(12) + negative),
        ("binary_little_endian", 2, bytes(12) + whole + negative + bytes(12)),
    ):
        with pytest.raises(ValueError, match=r"a list of -\d values cannot be"):
            read_ply(head.format(kind, faces).encode() + body)


def test_stl_is_read_as_text_and_as_bytes() -> None:
    corners = cut(read_off(off_text().encode())).points
    loops = "".join(
        "facet normal 0 0 1\n outer loop\n"
        + "".join(f"\tVERTEX {x} {y} {z}\n" for x, y, z in triangle)
        + " endloop\nendfacet\n"
        for triangle in corners.tolist()
    )
    text = f"solid floor\n{loops}endsolid\n"
    assert filled(read_stl(text.encode("utf-8-sig"))) == pytest.approx(100.0)
    rows = b"".join(struct.pack("<12fH", 0, 0, 1, *t.reshape(-1), 0) for t in corners)
    data = b"solid, and yet bytes".ljust(80) + struct.pack("<I", len(corners)) + rows
    assert filled(read_stl(data)) == pytest.approx(100.0)
    for wrong in (data[:-3].replace(b"solid", b"STLB "), b"ab", text[:-60].encode()[:200]):
        with pytest.raises(ValueError, match=r"bytes|within"):
            read_stl(wrong)


def threemf(model: str, packed: int = zipfile.ZIP_DEFLATED) -> bytes:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", packed) as archive:
        archive.writestr("3D/3dmodel.model", model)
    return made.getvalue()


MODEL = """<?xml version="1.0"?>
<model unit="centimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources>
<object id="1"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1000" y="0" z="0"/>
<vertex x="0" y="1000" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles>
</mesh></object>
<object id="2"><components><component objectid="1"/>
<component objectid="1" transform="-1 0 0 0 1 0 0 0 1 500 0 100"/></components></object>
</resources>
<build><item objectid="2" transform="1 0 0 0 1 0 0 0 1 0 0 300"/></build></model>"""


def test_3mf_builds_its_items_in_metres() -> None:
    points = read_3mf(threemf(MODEL)).points
    assert area(points) == pytest.approx(100.0)
    assert sorted({round(z, 6) for z in points[..., 2].reshape(-1).tolist()}) == [3.0, 4.0]
    assert points[..., 0].min() == pytest.approx(-5.0)
    normals = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    assert (normals[:, 2] > 0.0).all()


@pytest.mark.parametrize(
    ("model", "message"),
    [
        ('<!DOCTYPE a [<!ENTITY b "c">]><model/>', "declares a document type"),
        (MODEL.replace('objectid="1"', 'objectid="2"'), "too deep"),
        (MODEL.replace("centimeter", "furlong"), "unit 'furlong'"),
        (MODEL[:-20], "no XML"),
        ("<model>" + " " * 40_000_000 + "</model>", "grows to 38 MiB"),
    ],
)
def test_hostile_3mf_is_refused(model: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        read_3mf(threemf(model))
