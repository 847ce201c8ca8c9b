"""Meshes as files: read in whatever form, kept as the one form that server and browser read."""

from pathlib import Path
from typing import Any, Final

from scenery.console import UsageError

_Z_TO_Y: Final = ((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1))
"""Turns z up into y up, as glTF has it."""


def as_glb(path: Path, up: str, metres_a_unit: float) -> bytes:
    """A mesh of any form that trimesh reads, as GLB: y up, in metres, with its materials.

    Raises
    ------
    UsageError
        The file cannot be read.
    """
    import trimesh  # noqa: PLC0415  (takes a while to import, and checking needs it not)

    try:
        mesh: Any = trimesh.load_scene(path, process=False)
        if up == "z":
            mesh.apply_transform(_Z_TO_Y)
        if metres_a_unit != 1.0:
            mesh.apply_scale(metres_a_unit)
        return bytes(mesh.export(file_type="glb"))
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror or error}") from None
    # Readers of a dozen formats raise whatever broken bytes make of them.
    except Exception as error:  # noqa: BLE001
        raise UsageError(f"{path}: is no mesh that can be read: {error}") from None
