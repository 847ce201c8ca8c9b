"""Loads the world that the settings ask for: a scene file, or ground around a recorded crowd."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
import structlog
from pydantic import ValidationError

from esplanade.commandline.recording_settings import READING
from esplanade.planning import Place, Scene, Wall
from esplanade.planning.scene.mesh_file import MeshError, read_triangles
from esplanade.planning.scene.scene_file import SceneError, read_scene, scene_faults
from esplanade.recordings import (
    Crowd,
    RecordingError,
    open_doorways,
    read_crowd,
    read_walls,
    walls_beside,
)
from esplanade.server.patience import told_of
from esplanade.server.roster import Roster, RosterError, read_roster
from esplanade.server.settings import ServerSettings
from esplanade.server.world.rules import Rules

DEFAULT_SCENE: Final = Path(__file__).parent.parent / "scenes" / "gallery.json"

CROWD_MARGIN_M: Final = 2.0
CROWD_PLACES: Final = 8
CROWD_PLACE_INSET_M: Final = 1.0
DOORWAY_M: Final = 0.5
"""Walls drawn across a recorded trajectory are opened this wide."""
CATCH_UP: Final = 1.5
"""A replayed person may be this much faster than the recording, to catch up with it."""
MAX_TRIANGLES: Final = 400_000
"""A larger mesh is refused: each browser fetches it whole, and this many are 14 MB."""


log = structlog.get_logger(__name__)


class LoadingError(ValueError):
    """The scene or crowd cannot be run; the message names the file and the place in it."""


@dataclass(frozen=True)
class LoadedScene:
    """A scene and the rules that hold in it."""

    scene: Scene
    rules: Rules
    roster: Roster | None = None
    """The actors that walk in it from the beginning; None for those that it usually has."""
    triangles: bytes | None = None
    """The triangles of a mesh: nine little-endian 32-bit floats each, metres, z up."""
    crowd: Crowd | None = None
    """The recorded crowd that was read."""


@told_of("reading the scene")
def load_scene(settings: ServerSettings) -> LoadedScene:
    """Read what the settings name.

    Raises
    ------
    LoadingError
        A file cannot be read or does not hold what it should.
    """
    rules = Rules(
        person_radius_m=settings.person_radius_m,
        person_clearance_m=settings.person_radius_m,
        person_max_speed_mps=settings.person_max_speed_mps,
        person_walk_speed_mps=settings.person_walk_speed_mps,
        view_radius_m=settings.view_radius_m,
        view_limit=settings.view_limit,
        steps_radius_m=settings.steps_radius_m,
        steps_limit=settings.steps_limit,
        viewer_bytes=settings.viewer_bytes,
        tick_rate=settings.tick_rate,
    )
    roster = None if settings.roster is None else _read_roster(settings.roster)
    if settings.crowd is None:
        scene = _read_scene(settings.scene or DEFAULT_SCENE)
        triangles = None if scene.mesh is None else mesh_triangles(scene.mesh)
        return LoadedScene(scene, rules, roster, triangles)
    crowd = read_recording(settings.crowd, {name: getattr(settings, name) for name in READING})
    try:
        path = settings.walls or walls_beside(settings.crowd)
        walls = open_doorways(read_walls(path), crowd, DOORWAY_M) if path else []
        scene = _scene_around(crowd, walls)
    except RecordingError as error:
        raise LoadingError(str(error)) from None
    except ValidationError as error:
        raise LoadingError(str(SceneError(settings.crowd, scene_faults(error)))) from None
    return LoadedScene(scene, rules_for(rules, crowd), roster, crowd=crowd)


def read_recording(path: Path, reading: Mapping[str, Any]) -> Crowd:
    """Read a recorded crowd, by those of the settings `READING` that are given.

    Raises
    ------
    LoadingError
        The file cannot be read, or holds no crowd.
    """
    try:
        return read_crowd(
            path,
            reading.get("fps"),
            unit=reading.get("unit"),
            scale=reading.get("scale"),
            strict=bool(reading.get("strict")),
            columns=reading.get("columns") or (),
        )
    except RecordingError as error:
        raise LoadingError(str(error)) from None


def rules_for(rules: Rules, crowd: Crowd) -> Rules:
    """The rules by which recorded people can go where they went."""
    # They brush along walls: they are held to their tracks, not to a clearance.
    needed_mps = CATCH_UP * crowd.max_speed_mps
    fastest_mps = max(rules.person_max_speed_mps, needed_mps)
    return replace(rules, person_clearance_m=0.0, person_max_speed_mps=fastest_mps)


def tell_crowd(path: Path, crowd: Crowd) -> None:
    """Say in the log how a crowd was understood, and what of it is not as crowds are."""
    if (report := crowd.report) is None:
        return
    log.info("read the crowd", file=str(path), told=report.line)
    for remark in report.remarks:
        log.info("read the crowd", file=str(path), told=remark)
    for warning in report.warnings:
        log.warning("the crowd is odd", file=str(path), told=warning)


def _read_roster(path: Path) -> Roster:
    try:
        return read_roster(path)
    except RosterError as error:
        raise LoadingError(str(error)) from None


def _read_scene(path: Path) -> Scene:
    try:
        return read_scene(path)
    except OSError as error:
        raise LoadingError(f"{path}: cannot be read: {error.strerror or error}") from None
    except SceneError as error:
        raise LoadingError(str(error)) from None


def mesh_triangles(mesh: Path) -> bytes:
    """The triangles of a mesh, as `LoadedScene.triangles` has them.

    Raises
    ------
    LoadingError
        It cannot be read, or has more than `MAX_TRIANGLES`.
    """
    try:
        triangles = read_triangles(mesh)
    except MeshError as error:
        raise LoadingError(str(error)) from None
    if len(triangles) > MAX_TRIANGLES:
        raise LoadingError(
            f"{mesh}: it has {len(triangles)} triangles, but browsers are handed at most "
            f"{MAX_TRIANGLES}; make a simpler mesh of it"
        )
    return triangles.astype("<f4").tobytes()


def _scene_around(
    crowd: Crowd, walls: list[tuple[tuple[float, float], tuple[float, float]]]
) -> Scene:
    """Open ground around all recorded trajectories, with places along its edge to walk between."""
    x0, y0, x1, y1 = crowd.bounds
    bounds = (
        x0 - CROWD_MARGIN_M,
        y0 - CROWD_MARGIN_M,
        x1 + CROWD_MARGIN_M,
        y1 + CROWD_MARGIN_M,
    )
    return Scene(
        name=crowd.name[:64],
        bounds=bounds,
        walls=tuple(Wall(start=start, end=end) for start, end in walls),
        places=tuple(_places_along(bounds)),
    )


def _places_along(bounds: tuple[float, float, float, float]) -> list[Place]:
    """Places in the corners and in the middle of the sides, just inside the bounds."""
    x0, y0, x1, y1 = bounds
    middle = np.array([(x0 + x1) / 2.0, (y0 + y1) / 2.0])
    half = np.array([(x1 - x0) / 2.0, (y1 - y0) / 2.0]) - CROWD_PLACE_INSET_M
    places = []
    for number in range(CROWD_PLACES):
        angle = 2.0 * math.pi * number / CROWD_PLACES
        # Onto the rectangle: the larger coordinate of the direction reaches its edge.
        direction = np.array([math.cos(angle), math.sin(angle)])
        x, y = middle + half * direction / np.abs(direction).max()
        places.append(Place(name=f"edge {number + 1}", position=(float(x), float(y))))
    return places
