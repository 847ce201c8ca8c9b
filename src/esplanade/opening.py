"""Worlds of files that are no scenes: a mesh or a plan is imported before the world begins.

What is made of a file is kept under a digest of it, so that the next start finds it. `kept_scenes`
says for how long.
"""

import hashlib
import json
import os
import shutil
import sys
import tempfile
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.running import imported
from esplanade.files.content import read_content
from esplanade.kept_scenes import UNFINISHED, make_room, mark_used

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
    """Whether a file is a mesh or a plan, by its suffix, and others by what they hold."""
    suffix = path.suffix.lower()
    suffix = Path(path.stem).suffix.lower() if suffix == ".gz" else suffix
    if suffix in (*PLANS, *MESHES):
        return True
    if suffix != ".json":
        is_plan: Callable[[Path], bool] = imported("esplanade.scenery.plans.reading:is_plan")
        return path.is_file() and is_plan(path)
    try:
        content: Any = json.loads(read_content(path))
    except (ValueError, RecursionError):
        return False  # whoever reads it as a scene says what is wrong
    return isinstance(content, dict) and "bounds" not in content and "type" in content


def _scene_of(path: Path) -> Path:
    """The scene of a file: one that was made before, or a new one, of which figures are told."""
    folder = _folder(path)
    name = Path(path.stem).stem if path.suffix.lower() == ".gz" else path.stem
    made = folder / f"{name}.json"
    has_others = path.suffix.lower() in _HAS_OTHERS
    mark_used(folder)
    make_room(folder.parent, folder)
    if made.exists() and not has_others:
        sys.stderr.write(f"{path}: imported before, as {made}\n")
        return made
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        new = Path(tempfile.mkdtemp(prefix=UNFINISHED, dir=folder.parent))
    except OSError:
        elsewhere = Path(tempfile.mkdtemp(prefix="esplanade-"))
        folder = elsewhere / folder.name
        made = folder / made.name
        new = Path(tempfile.mkdtemp(prefix=UNFINISHED, dir=elsewhere))
    try:
        _import(path, new, folder, made.name)
        if has_others:
            shutil.rmtree(folder, ignore_errors=True)
        _put(new, made)
    finally:
        shutil.rmtree(new, ignore_errors=True)
    make_room(folder.parent, folder)
    return made


def _import(path: Path, new: Path, folder: Path, name: str) -> None:
    """Make a scene of this name in a folder that has another one once it is whole."""
    parser: Any = imported("esplanade.scenery.options:parser")()
    import_: Callable[[Namespace], int] = imported("esplanade.scenery.cli:import_")
    options = parser.parse_args(["import", str(path), "--out", str(new / name)])
    options.kept_in = folder
    if import_(options):
        raise UsageError(f"{path}: no scene can be made of it")


def _put(new: Path, made: Path) -> None:
    """Give a folder its name; what somebody else has put there meanwhile is as good."""
    try:
        new.rename(made.parent)
    except OSError as error:
        if not made.exists():
            raise UsageError(f"{made}: cannot be made: {error.strerror or error}") from None


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
    known = sources_digest().encode() + os.fsencode(path.name) + b"\0" + content
    try:
        folder = scenes_folder()
    except RuntimeError:  # nobody knows of a home
        folder = Path(tempfile.mkdtemp(prefix="esplanade-"))
    return folder / hashlib.sha256(known).hexdigest()[:16]
