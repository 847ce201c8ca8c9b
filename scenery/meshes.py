"""Conversion of mesh files into GLB, the form that server and browser read."""

from pathlib import Path
from typing import Final

from esplanade.planning.scene.mesh_file import open_mesh

_Z_TO_Y: Final = ((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1))
"""The rotation from z up to y up, which glTF requires."""


def as_glb(path: Path, up: str, metres_a_unit: float) -> bytes:
    """Convert a mesh that trimesh reads into GLB: y up, in metres, with its materials.

    Raises
    ------
    MeshError
        The file cannot be read.
    """
    mesh = open_mesh(path, materials=True)
    if up == "z":
        mesh.apply_transform(_Z_TO_Y)
    if metres_a_unit != 1.0:
        mesh.apply_scale(metres_a_unit)
    return bytes(mesh.export(file_type="glb"))
