"""The head of a recording: the program, the machine, and all that a zone is built of."""

import json
import platform
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, Self

import llvmlite.binding  # type: ignore[import-untyped]
import numba

from esplanade.commandline.provenance import software
from esplanade.planning import Scene
from esplanade.server.recording.container import SCENE, SETTINGS, WRITTEN_BY
from esplanade.server.recording.errors import ZoneRecordingError
from esplanade.server.world.rules import Rules
from esplanade.server.world.zone import Zone

FORMAT: Final = "esplanade recording 1"
MESH: Final = "mesh"
"""The name of an attached mesh begins so; the suffix of its file follows."""
_LIBRARIES: Final = ("numpy", "numba", "llvmlite", "scipy", "msgpack", "pydantic")
PROGRAM: Final = ("format", WRITTEN_BY, "sources sha256", "python", *_LIBRARIES)
"""Where any of these differs, nothing says that the same inputs make the same world."""
MACHINE: Final = ("processor", "processor features")
"""Compiled kernels may round otherwise on another processor."""


@dataclass(frozen=True)
class Built:
    """The settings that a zone is built of, beside its scene."""

    zone: str
    seed: int
    tick_s: float
    max_people: int
    most_actors: int
    person_radius_m: float
    rules: Rules
    names: bool
    """Whether people have their names in the recording."""
    chat: bool
    """Whether what people say is in it."""

    @classmethod
    def of(
        cls,
        zone: Zone,
        name: str,
        seed: int,
        person_radius_m: float,
        *,
        names: bool = False,
        chat: bool = False,
    ) -> Self:
        """The settings of a zone that runs."""
        people = zone.state.capacity - zone.most_actors
        return cls(
            name,
            seed,
            zone.tick_s,
            people,
            zone.most_actors,
            person_radius_m,
            zone.rules,
            names,
            chat,
        )


@dataclass(frozen=True)
class Head:
    """All that stands before the first tick of a recording."""

    about: Mapping[str, str]
    """The program and the machine, by `PROGRAM` and `MACHINE`."""
    built: Built
    scene: Scene
    mesh: tuple[str, bytes] | None = None
    """The suffix and the bytes of the scene's mesh."""

    @classmethod
    def of(cls, zone: Zone, built: Built) -> Self:
        """The head of a recording that this program makes of a zone.

        Raises
        ------
        OSError
            The scene's mesh cannot be read any more.
        """
        path = zone.scene.mesh
        mesh = None if path is None else (path.suffix, path.read_bytes())
        return cls(this_program(), built, zone.scene, mesh)

    def attachments(self) -> dict[str, bytes]:
        """The files that stand in a recording."""
        settings = json.dumps(asdict(self.built), indent=1).encode()
        found = {SCENE: self.scene.model_dump_json(indent=1).encode(), SETTINGS: settings}
        if self.mesh is not None:
            found[MESH + self.mesh[0]] = self.mesh[1]
        return found


def digest_name(attachment: str) -> str:
    """The name under which the metadata have the SHA-256 of an attachment."""
    return f"{attachment} sha256"


def this_program() -> dict[str, str]:
    """Versions of all that decides what becomes of inputs, and the target of compiled kernels."""
    config: Any = numba.config
    cpu = config.CPU_NAME or llvmlite.binding.get_host_cpu_name()
    features = config.CPU_FEATURES or llvmlite.binding.get_host_cpu_features().flatten()
    return {
        "format": FORMAT,
        **software(),
        "python": platform.python_version(),
        **{name: version(name) for name in _LIBRARIES},
        "processor": cpu,
        "processor features": features,
    }


def differing(about: Mapping[str, str], names: tuple[str, ...]) -> list[str]:
    """The ways in which a recording was made by another program or machine, in words."""
    mine = this_program()
    return [
        f"{name}: {_short(about.get(name, 'not told'))}, and here {_short(mine[name])}"
        for name in names
        if about.get(name) != mine[name]
    ]


def read_head(about: Mapping[str, str], files: Mapping[str, bytes], folder: Path) -> Head:
    """The head of a recording with these metadata and attachments.

    A mesh is written into the folder, where the scene then names it.

    Raises
    ------
    ZoneRecordingError
        An attachment is missing, or is not what it should be.
    """
    for name in (SCENE, SETTINGS):
        if name not in files:
            raise ZoneRecordingError(f"the attachment {name} is missing")
    try:
        told = json.loads(files[SETTINGS])
        built = Built(**{**told, "rules": Rules(**told["rules"])})
    except (ValueError, TypeError, KeyError) as error:
        raise ZoneRecordingError(f"the attachment {SETTINGS} cannot be read: {error}") from None
    try:
        scene = Scene.model_validate_json(files[SCENE])
    except ValueError as error:
        raise ZoneRecordingError(f"the attachment {SCENE} cannot be read: {error}") from None
    mesh = None
    if scene.mesh is not None:
        suffix = scene.mesh.suffix
        if f"{MESH}{suffix}" not in files:
            raise ZoneRecordingError(f"the attachment {MESH}{suffix} is missing")
        mesh = suffix, files[f"{MESH}{suffix}"]
        path = folder / f"{MESH}{suffix}"
        path.write_bytes(mesh[1])
        scene = scene.model_copy(update={"mesh": path})
    return Head(about, built, scene, mesh)


def _short(text: str) -> str:
    return text if len(text) <= 40 else f"{text[:37]}..."
