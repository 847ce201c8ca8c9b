"""A building in IFC is read in metres, with its doors open and its storeys named."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from esplanade.planning.scene.formats import ifc, ifc_triangles
from esplanade.planning.scene.mesh_file import MeshError, read_mesh

CUBE = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def house(path: Path, unit: str) -> None:
    """A slab of 10 m x 8 m and a door upon it."""
    ifcopenshell = pytest.importorskip("ifcopenshell")
    call: Any = pytest.importorskip("ifcopenshell.api").run
    model = ifcopenshell.file(schema="IFC4")

    def made(kind: str, name: str) -> Any:
        return call("root.create_entity", model, ifc_class=kind, name=name)

    project, storey = made("IfcProject", "P"), made("IfcBuildingStorey", "Ground floor")
    call("unit.assign_unit", model, length={"is_metric": True, "raw": unit})
    above = call("context.add_context", model, context_type="Model")
    body = call(
        "context.add_context",
        model,
        context_type="Model",
        context_identifier="Body",
        target_view="MODEL_VIEW",
        parent=above,
    )
    call("aggregate.assign_object", model, products=[storey], relating_object=project)
    for kind, (x, y, z) in (("IfcSlab", (10.0, 8.0, 0.2)), ("IfcDoor", (1.0, 0.1, 2.0))):
        part = made(kind, kind)
        ring = [(0.0, 0.0), (x, 0.0), (x, y), (0.0, y)]
        corners = [(east, north, up) for up in (0.0, z) for east, north in ring]
        shape = call(
            "geometry.add_mesh_representation",
            model,
            context=body,
            vertices=[corners],
            faces=[CUBE],
        )
        call("geometry.assign_representation", model, product=part, representation=shape)
        call("spatial.assign_container", model, products=[part], relating_structure=storey)
        call("geometry.edit_object_placement", model, product=part)
    model.write(str(path))


@pytest.mark.parametrize("unit", ["METERS", "MILLIMETERS"])
def test_a_building_is_read_in_metres(tmp_path: Path, unit: str) -> None:
    path = tmp_path / "house.ifc"
    house(path, unit)
    found = read_mesh(path)
    assert found.kind == "IFC"
    assert np.ptp(found.triangles.reshape(-1, 3), axis=0) == pytest.approx([10.0, 8.0, 0.2])
    assert dict(found.passed) == {"doors, taken as open": 1}
    assert found.told == ("storeys: Ground floor",)


def test_what_is_no_building_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "house.ifc"
    path.write_text("nonsense")
    with pytest.raises(MeshError, match=r"house.ifc: .*(does not begin as IFC|pip install)"):
        read_mesh(path)


def test_feet_are_metres_and_no_unit_is_said(tmp_path: Path) -> None:
    ifcopenshell = pytest.importorskip("ifcopenshell")
    path = tmp_path / "house.ifc"
    house(path, "METERS")
    plain = path.read_text()
    metre = "IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)"
    feet = (
        "IFCCONVERSIONBASEDUNIT(#901,.LENGTHUNIT.,'FOOT',#902);\n"
        "#901=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);\n"
        f"#902=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.3048),#903);\n#903={metre}"
    )
    path.write_text(plain.replace(metre, feet))
    found = read_mesh(path).triangles.reshape(-1, 3)
    assert np.ptp(found, axis=0) == pytest.approx([3.048, 2.4384, 0.06096])
    model = ifcopenshell.open(str(path))
    for project in model.by_type("IfcProject"):
        project.UnitsInContext = None
    for units in model.by_type("IfcUnitAssignment"):
        model.remove(units)
    model.write(str(path))
    assert "it names no unit: taken for metres" in read_mesh(path).told[-1]


def test_a_library_that_ends_or_never_does_is_a_fault_of_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("ifcopenshell")
    script = tmp_path / "ending.py"
    monkeypatch.setattr(ifc_triangles, "__file__", str(script))
    path = tmp_path / "house.ifc"
    path.write_text("ISO-10303-21;")
    script.write_text("import os\nos.abort()\n")
    with pytest.raises(MeshError, match="IfcOpenShell ended on it with status -6"):
        read_mesh(path)
    script.write_text("import time\ntime.sleep(600)\n")
    monkeypatch.setattr(ifc, "_LONGEST_S", 0.2)
    with pytest.raises(MeshError, match=r"IfcOpenShell was not done with it after 0\.2 s"):
        read_mesh(path)
