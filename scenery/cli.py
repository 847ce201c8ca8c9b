"""`esplanade scene`: check a scene, draw it, make one of a mesh."""

import json
import sys
from argparse import Namespace
from pathlib import Path

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import UsageError
from esplanade.commandline.output import console, made_folder
from esplanade.commandline.progress import progress
from esplanade.planning import Scene
from esplanade.planning.ground.surfaces import GroundError
from esplanade.planning.scene.mesh_file import MeshError
from esplanade.planning.scene.scene_file import SceneError, read_scene
from esplanade.scenery import inventory, pictures
from esplanade.scenery.bodies import made_body
from esplanade.scenery.download import local_file
from esplanade.scenery.importing import import_mesh
from esplanade.scenery.layer_maps import layer_maps


def check(options: Namespace) -> int:
    """Say what is wrong with a scene and where, or what it holds."""
    try:
        scene = _read(options.scene)
    except SceneError as error:
        if options.json:
            print(json.dumps({"faults": error.faults}, indent=1))
        return exit_codes.FAILED if options.json else _refuse(error)
    try:
        found = inventory.take_inventory(scene, options.cell)
    except (GroundError, MeshError) as error:
        return _refuse(SceneError(options.scene, (str(error),)))
    if options.json:
        print(json.dumps(found.figures(), indent=1))
    else:
        inventory.show(console(), found)
        for fault in found.faults:
            print(f"{options.scene}: {fault}", file=sys.stderr)
    return exit_codes.FAILED if found.faults else exit_codes.OK


def render(options: Namespace) -> int:
    """Draw every layer of a scene."""
    pictures.require_matplotlib()
    body = made_body(options.body)
    try:
        scene = _read(options.scene)
    except SceneError as error:
        return _refuse(error)
    folder = made_folder("--out", options.out)
    try:
        views = layer_maps(scene, options.cell, body, options.start, options.goal)
    except (GroundError, MeshError) as error:
        return _refuse(SceneError(options.scene, (str(error),)))
    files = []
    with progress() as shown:
        task = shown.add_task("drawing", total=len(views))
        for view in views:
            files += pictures.draw_layer(view, folder)
            shown.advance(task)
    print(*files, sep="\n")
    return exit_codes.OK


def import_(options: Namespace) -> int:
    """Make a scene of a mesh."""
    with progress(share=True) as shown:
        task = shown.add_task("", total=1.0)

        def tell(doing: str, share: float) -> None:
            shown.update(task, description=doing, completed=share)

        with local_file(options.mesh, tell) as mesh:
            scene = import_mesh(
                mesh,
                options.out,
                options.up,
                options.scale,
                options.cell,
                options.name,
                options.spawn,
                options.places,
                tell,
            )
    print(
        f"{options.out}: {len(scene.places)} places; run it: esplanade serve --scene {options.out}"
    )
    return exit_codes.OK


def _read(path: Path) -> Scene:
    try:
        return read_scene(path)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror or error}") from None


def _refuse(error: SceneError) -> int:
    """Every fault in a line of its own, with the file that it is in."""
    print(error, file=sys.stderr)
    return exit_codes.FAILED
