"""Plans as other programs write them: encodings, systems, units, kinds, and where none is given."""

import gzip
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from esplanade.cli import main
from esplanade.commandline.errors import UsageError
from esplanade.planning.scene.scene_file import read_scene
from esplanade.scenery.plans.reading import is_plan, read_plan
from esplanade.scenery.plans.scene_of_plan import scene_of_plan
from tests.scenery.plans.test_plans import JUPEDSIM

pytest.importorskip("shapely")

RING = "0 0, 20 0, 20 10, 0 10"
SQUARE = [[0, 0], [20, 0], [20, 10], [0, 10], [0, 0]]
OTHER = [[30, 0], [40, 0], [40, 10], [30, 10], [30, 0]]


def written(path: Path, content: str | bytes) -> Path:
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def geojson(*parts: tuple[Any, dict[str, str] | None], **more: Any) -> str:
    features = [
        {"type": "Feature", "properties": known, "geometry": geometry} for geometry, known in parts
    ]
    return json.dumps({"type": "FeatureCollection", "features": features, **more})


def polygon(*rings: list[list[float]]) -> dict[str, Any]:
    return {"type": "Polygon", "coordinates": rings}


def system(name: str) -> dict[str, Any]:
    return {"type": "name", "properties": {"name": name}}


@pytest.mark.parametrize(
    "text",
    [
        f"POLYGON (({RING}))",
        f"POLYGON (({RING}, 0.0 0.0))",
        f"POLYGON EMPTY\nPOLYGON (({RING}, 0 0))",
        f"-- it\nGEOMETRYCOLLECTION (POLYGON (({RING})), LINESTRING (1 1, 2 1, 2 3), POINT EMPTY)",
        "MULTIPOLYGON Z (((0 0 1, 10 0 1, 10 10 1, 0 10 1)), ((10 0 1, 20 0 1, 20 10 1, 10 10 1)))",
    ],
)
def test_rings_need_not_come_back_and_empty_parts_are_none(tmp_path: Path, text: str) -> None:
    storey = read_plan(written(tmp_path / "a.wkt", text))
    assert storey.walkable.area == pytest.approx(200.0)
    assert len(storey.walls) == (2 if "LINESTRING" in text else 0)


@pytest.mark.parametrize("name", ["a.txt", "a.wkt.gz", "a"])
def test_a_plan_shows_itself_whatever_its_suffix(tmp_path: Path, name: str) -> None:
    text = f"# a hall\nPOLYGON (({RING}))".encode()
    path = written(tmp_path / name, gzip.compress(text) if name.endswith("gz") else text)
    assert is_plan(path)
    assert read_plan(path).walkable.area == pytest.approx(200.0)
    assert not is_plan(written(tmp_path / "b.txt", "v 0 0 0\n"))


def test_systems_of_coordinates_are_heeded_and_said(tmp_path: Path) -> None:
    degrees = "SRID=4326;POLYGON ((13.4 52.5, 13.401 52.5, 13.401 52.501, 13.4 52.501))"
    storey = read_plan(written(tmp_path / "a.wkt", degrees))
    assert storey.walkable.area == pytest.approx(111.32**2 * np.cos(np.radians(52.5)), rel=1e-3)
    far = [[x + 1_500_000, y + 6_890_000] for x, y in SQUARE]
    mercator = geojson((polygon(far), {}), crs=system("EPSG:3857"))
    storey = read_plan(written(tmp_path / "b.geojson", mercator))
    assert storey.walkable.area == pytest.approx(200.0 * np.cos(np.radians(52.55)) ** 2, rel=0.01)
    assert "Web Mercator" in storey.remarks[0]
    utm = geojson((polygon(SQUARE), {}), crs=system("urn:ogc:def:crs:EPSG::25832"))
    storey = read_plan(written(tmp_path / "c.geojson", utm))
    assert storey.walkable.area == pytest.approx(200.0)
    assert "EPSG::25832: taken for metres" in storey.remarks[0]
    with pytest.raises(UsageError, match="different systems: SRID 25832, 4326"):
        read_plan(written(tmp_path / "d.wkt", f"{degrees}\nSRID=25832;POLYGON (({RING}))"))


def test_kinds_that_are_not_known_are_said(tmp_path: Path) -> None:
    parts = ((polygon(SQUARE), {"kind": "room"}), (polygon(OTHER), {"kind": "water"}))
    line = {"type": "LineString", "coordinates": [[1, 1], [5, 1]]}
    text = geojson(*parts, (None, {}), (line, {"type": "path"}), (polygon(SQUARE), None))
    storey = read_plan(written(tmp_path / "a.geojson", text))
    assert storey.remarks == [
        "1 polygons of kind 'water' are taken for floors",
        "1 lines of kind 'path' are taken for walls",
    ]


@pytest.mark.parametrize("encoding", ["latin-1", "utf-16"])
def test_xml_is_decoded_as_it_is_not_as_it_says(tmp_path: Path, encoding: str) -> None:
    text = f'<?xml version="1.0" encoding="{encoding}"?>' + JUPEDSIM.replace("exit", "s\u00fcd")
    storey = read_plan(written(tmp_path / "a.xml", text.encode(encoding)))
    assert [name for name, _ in storey.doors] == ["s\u00fcd"]


def test_a_unit_of_jupedsim_can_be_given(tmp_path: Path) -> None:
    path = written(tmp_path / "a.xml", JUPEDSIM.replace('unit="m"', 'unit="ell"'))
    with pytest.raises(UsageError, match="'ell' is unknown: --unit says what it is"):
        read_plan(path)
    assert read_plan(path, unit_m=0.5).walkable.area == pytest.approx(20.0)


@pytest.mark.parametrize("kind", ["trinary", "negated", "raw", "deep", "transparent"])
def test_images_of_ros_maps_are_read_as_their_map_says(tmp_path: Path, kind: str) -> None:
    image = pytest.importorskip("PIL.Image")
    free = np.zeros((40, 60), bool)
    free[5:35, 5:55] = True
    pixels = {
        "trinary": np.where(free, 254, 0).astype(np.uint8),
        "negated": np.where(free, 1, 255).astype(np.uint8),
        "raw": np.where(free, 0, 100).astype(np.uint8),
        "deep": np.where(free, 65_000, 0).astype(np.uint16),
        "transparent": np.stack([np.full(free.shape, 254), 255 * free], axis=-1).astype(np.uint8),
    }[kind]
    if kind == "raw":
        pixels[0] = 255
    image.fromarray(pixels).save(tmp_path / "map.png")
    text = "image: map.png\nresolution: 0.1\norigin: [0, 0, 0]\n"
    text += f"negate: {int(kind == 'negated')}\nmode: {'raw' if kind == 'raw' else 'trinary'}\n"
    storey = read_plan(written(tmp_path / "a.yaml", text))
    assert storey.walkable.area == pytest.approx(15.0)
    with pytest.raises(UsageError, match="its mode 'other' is none of trinary, scale, raw"):
        read_plan(written(tmp_path / "a.yaml", text.replace("mode: ", "mode: other #")))


def drawing(version: str = "R2010") -> str:
    ezdxf = pytest.importorskip("ezdxf")
    made = ezdxf.new(version)
    made.header["$INSUNITS"] = 6
    ring = [(0, 0), (2000, 0), (2000, 1000), (0, 1000)]
    made.modelspace().add_lwpolyline(ring, close=True)
    text = io.StringIO()
    made.write(text)
    found: str = text.getvalue()
    return found


def entities(text: str) -> str:
    """The entities of a drawing, without any other section."""
    begin = text.rindex("  0\nSECTION", 0, text.index("ENTITIES"))
    return text[begin : text.index("ENDSEC", begin)] + "ENDSEC\n  0\nEOF\n"


def test_a_drawing_without_a_header_wants_its_unit(tmp_path: Path) -> None:
    path = written(tmp_path / "a.dxf", entities(drawing()))
    with pytest.raises(UsageError, match=r"no header, .*: give --unit, as in --unit mm"):
        read_plan(path)
    storey = read_plan(path, unit_m=0.01)
    assert storey.bounds() == pytest.approx((0.0, 0.0, 20.0, 10.0))
    assert len(storey.walls) == 4
    scene = tmp_path / "a.json"
    words = ["scene", "import", str(path), "--out", str(scene)]
    assert main([*words, "--unit", "cm"]) == 0
    assert read_scene(scene).bounds == (0.0, 0.0, 20.0, 10.0)
    assert main([*words, "--unit", "cm", "--scale", "2"]) == 2


@pytest.mark.parametrize("version", ["R12", "R2000", "R2018"])
def test_a_drawing_may_be_of_bytes(tmp_path: Path, version: str) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    made = ezdxf.new(version)
    if version != "R12":
        made.header["$INSUNITS"] = 4
    made.modelspace().add_line((0, 0), (3000, 4000))
    path = tmp_path / "a.dxf"
    made.saveas(path, fmt="bin")
    storey = read_plan(path)
    metres = 1.0 if version == "R12" else 1e-3
    assert storey.bounds() == pytest.approx((0.0, 0.0, 3000 * metres, 4000 * metres))
    assert any("names no unit" in remark for remark in storey.remarks) == (version == "R12")
    path.write_bytes(path.read_bytes()[:300])
    with pytest.raises(UsageError, match=r"a.dxf: it is no binary DXF that can be read"):
        read_plan(path)


def test_names_that_stand_twice_are_numbered(tmp_path: Path) -> None:
    place = {"type": "Point", "coordinates": [1, 1]}
    door = {"type": "LineString", "coordinates": [[10, 4], [10, 6]]}
    named = {"name": "b\u00e4r"}
    gate = {"kind": "door", "name": "gate"}
    text = geojson(
        (polygon(SQUARE), {}), (place, named), (place, named), (door, gate), (door, gate)
    )
    path = written(tmp_path / "a.geojson", text.encode().decode("unicode_escape").encode("latin-1"))
    scene = scene_of_plan([read_plan(path)], "a")
    assert [each.name for each in scene.places] == ["b\u00e4r", "b\u00e4r 2"]
    assert [each.name for each in scene.doors] == ["gate", "gate 2"]


def test_a_drawing_of_blocks_alone_draws_nothing(tmp_path: Path) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    made = ezdxf.new()
    made.blocks.new("chair").add_line((0, 0), (1, 0))
    path = tmp_path / "a.dxf"
    made.saveas(path)
    with pytest.raises(UsageError, match="it defines 1 blocks and places none of them"):
        read_plan(path)
