"""Worlds of files that are no scenes: a mesh or a plan is imported before the world begins.

What is made of a file is kept under a digest of it, so that the next start finds it. `kept_scenes`
says for how long.
"""

import hashlib
import json
import sys
import tempfile
from argparse import Namespace
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.running import imported
from esplanade.kept_scenes import make_room, mark_used

PLANS: Final = (".wkt", ".geojson", ".xml", ".yaml", ".yml", ".dxf")
MESHES: Final = (".obj", ".off", ".ply", ".stl", ".gltf", ".glb", ".3mf", ".ifc")
_HAS_OTHERS: Final = (".yaml", ".yml", ".gltf")
"""Files that name other files: whether those are the same, their own digest does not tell."""


def serve(options: Namespace) -> int:
    """Run a server on the scene that is given, or on what it is made of."""
    return _run("esplanade.server.cli:run", options)


def run(options: Namespace) -> int:
    """Run a world without a server, likewise."""
    return _run("esplanade.server.offline.cli:run", options)


def _run(name: str, options: Namespace) -> int:
    with_scene(options)
    command: Callable[[Namespace], int] = imported(name)
    return command(options)


def with_scene(options: Namespace) -> None:
    """Put a scene into the options in place of a mesh or a plan.

    Raises
    ------
    UsageError
        The file cannot be made into a scene.
    """
    given: Path | None = getattr(options, "scene", None)
    if given is not None and is_made_into_a_scene(given):
        options.scene = _scene_of(given)


def is_made_into_a_scene(path: Path) -> bool:
    """Whether a file is a mesh or a plan, by its suffix, and JSON by what it holds."""
    suffix = path.suffix.lower()
    if suffix != ".json":
        return suffix in (*PLANS, *MESHES)
    try:
        content: Any = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError):
        return False  # whoever reads it as a scene says what is wrong
    return isinstance(content, dict) and "bounds" not in content and "type" in content


def _scene_of(path: Path) -> Path:
    """The scene of a file: one that was made before, or a new one, of which figures are told."""
    folder = _folder(path)
    made = folder / f"{path.stem}.json"
    mark_used(folder)
    make_room(scenes_folder(), folder)
    if made.exists() and path.suffix.lower() not in _HAS_OTHERS:
        sys.stderr.write(f"{path}: imported before, as {made}\n")
        return made
    parser: Any = imported("esplanade.scenery.options:parser")()
    import_: Callable[[Namespace], int] = imported("esplanade.scenery.cli:import_")
    try:
        if import_(parser.parse_args(["import", str(path), "--out", str(made)])):
            raise UsageError(f"{path}: no scene can be made of it")
    finally:
        with suppress(OSError):
            folder.rmdir()  # nothing was made: there is nothing in it
    make_room(scenes_folder(), folder)
    return made


def scenes_folder() -> Path:
    """The folder of all scenes that were made so."""
    return Path.home() / ".cache" / "esplanade" / "scenes"


def _folder(path: Path) -> Path:
    """The folder of what is made of this very file by this very version."""
    from esplanade.commandline.provenance import sources_digest  # noqa: PLC0415

    try:
        content = path.read_bytes()
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror or error}") from None
    digest = hashlib.sha256(sources_digest().encode() + content).hexdigest()[:16]
    try:
        folder = scenes_folder() / digest
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, RuntimeError):
        folder = Path(tempfile.mkdtemp(prefix="esplanade-"))
    return folder
