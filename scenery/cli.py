"""`esplanade scene`: check a scene, draw it, make one of a mesh."""

import json
import sys
from argparse import Namespace
from pathlib import Path

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import UsageError
from esplanade.commandline.output import console, made_folder
from esplanade.commandline.progress import progress
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.ground.surfaces import GroundError
from esplanade.planning.scene.bounded_reading import suffix_of
from esplanade.planning.scene.mesh_file import MeshError
from esplanade.planning.scene.scene_file import SceneError, read_scene
from esplanade.planning.scene.world_file import WorldError, read_world
from esplanade.scenery import inventory, mesh_report, pictures, world_check
from esplanade.scenery.bodies import made_body
from esplanade.scenery.download import local_file
from esplanade.scenery.importing import NAME_LENGTH, import_mesh, with_places
from esplanade.scenery.layer_maps import layer_maps
from esplanade.scenery.plans.reading import is_plan, read_plan, says_its_unit
from esplanade.scenery.plans.scene_of_plan import scene_of_plan
from esplanade.scenery.scene_text import scene_text
from esplanade.scenery.turning import write_turned
from esplanade.scenery.values import UNITS

_WITH_UNITS = (".ifc", ".3mf")


def check(options: Namespace) -> int:
    """Say what is wrong with a scene or a world and where, or what it holds."""
    if options.world:
        return _check_world(options)
    try:
        scene = _read(options.scene)
    except SceneError as error:
        if options.json:
            print(json.dumps({"faults": error.faults, "places": error.spots}, indent=1))
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


def _check_world(options: Namespace) -> int:
    path = options.scene
    try:
        world = read_world(path)
        zones = world_check.check_zones(world, options.cell)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror or error}") from None
    except WorldError as error:
        if options.json:
            print(json.dumps({"faults": error.faults, "places": error.spots}, indent=1))
        else:
            print(error, file=sys.stderr)
        return exit_codes.FAILED
    except (GroundError, MeshError) as error:
        return _refuse(SceneError(path, (str(error),)))
    faults = [fault for zone in zones for fault in zone.faults]
    if options.json:
        told = {zone.name: zone.figures() for zone in zones}
        print(json.dumps({"name": world.file.name, "zones": told, "faults": faults}, indent=1))
    else:
        world_check.show(console(), world, zones)
        for fault in faults:
            print(f"{path}: {fault}", file=sys.stderr)
    return exit_codes.FAILED if faults else exit_codes.OK


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
            files += pictures.draw_layer(view, folder, options.picture)
            shown.advance(task)
    print(*files, sep="\n")
    return exit_codes.OK


def import_(options: Namespace) -> int:
    """Make a scene of a mesh or of plans."""
    if options.unit is not None and options.scale != 1.0:
        raise UsageError("--unit and --scale: give one of them, not both")
    if all(is_plan(Path(name)) for name in options.mesh):
        return _import_plans(options)
    if len(options.mesh) > 1:
        raise UsageError("FILE: one mesh is made into a scene; several files are plans of storeys")
    if options.unit is not None and suffix_of(Path(options.mesh[0])) in _WITH_UNITS:
        raise UsageError(
            "--unit: this mesh says its unit itself; --scale makes it larger or smaller"
        )
    with progress(share=True) as shown:
        task = shown.add_task("", total=1.0)

        def tell(doing: str, share: float) -> None:
            shown.update(task, description=doing, completed=share)

        with local_file(options.mesh[0], tell) as mesh:
            made = import_mesh(
                mesh,
                options.out,
                options.up,
                UNITS[options.unit] if options.unit else options.scale,
                options.cell,
                options.name,
                options.spawn,
                options.places,
                tell,
                options.recentre,
            )
    written = console()
    written.print(
        f"{len(made.mesh.triangles)} triangles of {made.mesh.kind}", highlight=False, soft_wrap=True
    )
    mesh_report.show_passed(written, made.mesh.passed)
    for line in made.mesh.told:
        written.print(line, highlight=False, markup=False, soft_wrap=True)
    _tell(made.scene, made.grid, options)
    return exit_codes.OK


def _import_plans(options: Namespace) -> int:
    paths = [Path(name) for name in options.mesh]
    unit_m = UNITS[options.unit] if options.unit else None
    own = [says_its_unit(path) for path in paths]
    if unit_m is not None and any(own) and not all(own):
        raise UsageError("--unit: these plans are of several forms; import them one by one")
    storeys = [read_plan(path, options.layer, unit_m) for path in paths]
    scale = unit_m if unit_m is not None and not any(own) else options.scale
    name = options.name or storeys[0].name
    try:
        scene = scene_of_plan(storeys, name, scale, options.recentre)
    except ValueError as error:
        raise UsageError(f"{options.mesh[0]}: {error}") from None
    scene, grid = with_places(scene, options.cell, options.spawn, options.places)
    try:
        options.out.write_text(scene_text(scene), encoding="utf-8")
    except OSError as error:
        raise UsageError(f"--out: {error}") from None
    shown = console()
    for storey in storeys:
        for remark in storey.remarks:
            shown.print(f"{storey.name}: {remark}", highlight=False, markup=False, soft_wrap=True)
    parts = f"{len(scene.polygons)} polygons, {len(scene.walls)} walls, {len(scene.doors)} doors"
    shown.print(parts, highlight=False)
    _tell(scene, grid, options)
    return exit_codes.OK


def turn(options: Namespace) -> int:
    """Write a scene turned about the vertical."""
    try:
        scene = _read(options.scene)
    except SceneError as error:
        return _refuse(error)
    if options.name:
        scene = scene.model_copy(update={"name": options.name[:NAME_LENGTH]})
    made = write_turned(scene, options.degrees, options.out)
    x0, y0, x1, y1 = made.bounds
    print(f"{options.out}: turned by {options.degrees:g} degrees, {x1 - x0:g} m x {y1 - y0:g} m")
    return exit_codes.OK


def schema(options: Namespace) -> int:
    """Write the JSON Schema of scenes."""
    made = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **Scene.model_json_schema(),
    }
    try:
        options.out.write_text(json.dumps(made, indent=1, ensure_ascii=False) + "\n", "utf-8")
    except OSError as error:
        raise UsageError(f"--out: {error}") from None
    print(f'{options.out}: name it in a scene as "$schema": "{options.out.name}"')
    return exit_codes.OK


def _tell(scene: Scene, grid: LayeredGrid, options: Namespace) -> None:
    """Say what was made, with a picture of it where matplotlib is installed."""
    shown, out = console(), options.out
    told = out if options.kept_in is None else options.kept_in / out.name
    if any(scene.origin_m):
        x, y, z = (0.0 - c for c in scene.origin_m)
        shown.print(f"moved by {x:g}, {y:g}, {z:g} m to the origin", highlight=False)
    mesh_report.show_floors(shown, grid)
    try:
        pictures.require_matplotlib()
    except UsageError:
        print("no picture: it needs matplotlib (pip install 'esplanade[scene]')")
    else:
        picture = out.with_suffix(f".{options.picture}")
        try:
            pictures.draw_heights(grid, scene.name, picture)
        except OSError as error:
            raise UsageError(f"{picture}: cannot be written: {error.strerror or error}") from None
        print(f"{told.with_suffix(picture.suffix)}: a picture of it")
    print(f"{told}: {len(scene.places)} places; run it: esplanade serve --scene {told}")


def _read(path: Path) -> Scene:
    try:
        return read_scene(path)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror or error}") from None


def _refuse(error: SceneError) -> int:
    """Every fault in a line of its own, with the file that it is in."""
    print(error, file=sys.stderr)
    return exit_codes.FAILED
