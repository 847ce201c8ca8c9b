"""`esplanade scene export`: a scene written for other programs."""

from argparse import Namespace
from pathlib import Path

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import UsageError
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.ground.surfaces import GroundError
from esplanade.planning.scene.mesh_file import MeshError
from esplanade.planning.scene.scene_file import SceneError, read_scene
from esplanade.scenery.exports.drawing import draw_plan
from esplanade.scenery.exports.glb import scene_as_glb
from esplanade.scenery.exports.layers import LayerCells, layers_of
from esplanade.scenery.exports.ros import layer_as_pgm, layer_as_yaml
from esplanade.scenery.exports.wkt import layer_as_wkt

SUFFIXES = (".glb", ".wkt", ".yaml", ".png", ".svg", ".pdf")


def export(options: Namespace) -> int:
    """Write a scene in the form that the suffix of the file names."""
    out = options.out
    if out.suffix not in SUFFIXES:
        raise UsageError(f"--out: {out.suffix or out.name!r} is none of {', '.join(SUFFIXES)}")
    try:
        scene = read_scene(options.scene)
        layers = layers_of(scene, LayeredGrid.from_scene(scene, options.cell))
    except OSError as error:
        raise UsageError(f"{options.scene}: cannot be read: {error.strerror or error}") from None
    except (GroundError, MeshError, SceneError) as error:
        raise UsageError(str(error)) from None
    try:
        files = write_layers(scene, layers, options.metres_per_cm, out)
    except OSError as error:
        raise UsageError(f"--out: {error}") from None
    print(*files, sep="\n")
    return exit_codes.OK


def write_layers(
    scene: Scene, layers: list[LayerCells], metres_a_cm: float, out: Path
) -> list[Path]:
    """Write the file, or one for each layer; returns all of them."""
    if out.suffix == ".glb":
        out.write_bytes(scene_as_glb(scene, layers))
        return [out]
    files = []
    for layer in layers:
        path = out if not layer.number else out.with_stem(f"{out.stem}-{layer.number}")
        files.append(path)
        match out.suffix:
            case ".wkt":
                path.write_text(layer_as_wkt(layer), encoding="utf-8")
            case ".yaml":
                image = path.with_suffix(".pgm")
                image.write_bytes(layer_as_pgm(layer))
                path.write_text(layer_as_yaml(layer, image.name), encoding="utf-8")
                files.append(image)
            case _:
                draw_plan(scene, layer, metres_a_cm, path)
    return files
