"""The provenance of trajectories: the software, the command, and all files that a world is made of.

There is no time of day in it: the same world gives the same file.
"""

from pathlib import Path
from typing import NamedTuple

from esplanade.commandline.provenance import digest_if_there, software
from esplanade.server.settings import ServerSettings
from esplanade.server.world.zone import Zone


class Origin(NamedTuple):
    """How a world came to be: the command, its settings, and the files that were read."""

    command: str
    settings: ServerSettings
    files: dict[str, Path]
    """By what they are: scene, mesh, recording, walls, roster."""


def files_of(settings: ServerSettings, scene: Path | None, mesh: Path | None) -> dict[str, Path]:
    """The files that a world is made of."""
    found = {
        "scene": scene,
        "mesh": mesh,
        "recording": settings.crowd,
        "walls": settings.walls,
        "roster": settings.roster,
    }
    return {name: path for name, path in found.items() if path is not None}


def provenance_of(origin: Origin, zone: Zone, fps: float) -> dict[str, str]:
    """The head of a file."""
    told = {**software(), "command": origin.command, "world": zone.scene.name}
    for name, path in origin.files.items():
        told[name] = path.name
        told[f"{name} sha256"] = digest_if_there(path)
    told["seed"] = str(origin.settings.seed)
    told["ticks a second"] = f"{1.0 / zone.tick_s:.10g}"
    told["time"] = f"seconds of the world; frame k is at k / {fps:.10g} s"
    return told
