"""`esplanade scene`: check a scene, draw it, make one of a mesh."""

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from typing import Final

from rich.console import Console

from esplanade.planning.scene.scene_file import SceneError
from esplanade.scenery import inventory, pictures
from esplanade.scenery.console import UsageError, open_scene, progress
from esplanade.scenery.download import local_file
from esplanade.scenery.importing import import_mesh
from esplanade.scenery.options import parser
from esplanade.scenery.views import layer_views

EXIT_WELL: Final = 0
EXIT_WRONG: Final = 1
EXIT_USAGE: Final = 2


def run(argv: Sequence[str]) -> int:
    """Do what the command line says; returns the exit code."""
    options = parser().parse_args(argv)
    try:
        return _COMMANDS[options.command](options)
    except SceneError as error:
        print(error, file=sys.stderr)
        return EXIT_WRONG
    except UsageError as error:
        print(f"esplanade scene {options.command}: {error}", file=sys.stderr)
        return EXIT_USAGE


def _check(options: argparse.Namespace) -> int:
    try:
        scene = open_scene(options.scene)
    except SceneError as error:
        if not options.json:
            raise
        print(json.dumps({"faults": error.faults}, indent=1))
        return EXIT_WRONG
    found = inventory.take_inventory(scene, options.cell)
    if options.json:
        print(json.dumps(found.figures(), indent=1))
    else:
        inventory.show(Console(), found)
        for fault in found.faults:
            print(f"{options.scene}: {fault}", file=sys.stderr)
    return EXIT_WRONG if found.faults else EXIT_WELL


def _render(options: argparse.Namespace) -> int:
    pictures.require_matplotlib()
    scene = open_scene(options.scene)
    try:
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"--out: {error}") from None
    views = layer_views(scene, options.cell, options.body, options.start, options.goal)
    files = []
    with progress() as shown:
        task = shown.add_task("drawing", total=len(views))
        for view in views:
            files += pictures.draw_layer(view, options.out)
            shown.advance(task)
    print(*files, sep="\n")
    return EXIT_WELL


def _import(options: argparse.Namespace) -> int:
    if options.out.suffix != ".json":
        raise UsageError(f"--out: a scene is a .json file, not {options.out.name}")
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
    return EXIT_WELL


_COMMANDS: Final[dict[str, Callable[[argparse.Namespace], int]]] = {
    "check": _check,
    "render": _render,
    "import": _import,
}
