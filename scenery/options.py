"""The options of `esplanade scene`."""

from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else
from typing import Final

from esplanade.commandline.parser import Parser
from esplanade.commandline.pictures import add_picture
from esplanade.commandline.readers import Folder, InputFile, Number, OutputFile, Whole
from esplanade.scenery.values import UNITS, body, point, where

DEFAULT_CELL_M: Final = 0.25
"""The width that the server takes."""
DESCRIPTION: Final = "Check a scene, draw it floor by floor, or make one of a building's mesh."
EPILOG: Final = """\
examples:
  esplanade scene check scenes/gallery.json
  esplanade scene check --world scenes/town.json
  esplanade scene render scenes/gallery.json --body child --out pictures
  esplanade scene render my.json --from gate --to 12,3,3.5 --out pictures
  esplanade scene import house.obj --up y --out house.json
  esplanade scene import https://example.org/hall.glb --out hall.json
  esplanade scene turn scenes/gallery.json --degrees 30 --out turned.json
  esplanade scene export my.json --out my.wkt

bodies: adult, child, or a preset with other measures in metres, such as
child,height=1.1 or radius=0.3,height=1.9,step=0.4,leg=0.9,edge=24 (an adult otherwise;
edge: how many cells in a row it may stay on an edge)

exit code: 0 all is well, 1 something is wrong with the scene, 2 wrong usage, or a file that
cannot be read or written
"""


def parser() -> Parser:
    """The commands; the help of the whole shows how each is called."""
    made = Parser("esplanade scene", description=DESCRIPTION)
    commands = made.add_subparsers(dest="command", metavar="COMMAND", required=True)
    parts = [
        _check(commands),
        _render(commands),
        _import(commands),
        _export(commands),
        _turn(commands),
        _schema(commands),
    ]
    usages = "".join(part.format_usage().replace("usage: ", "  ") for part in parts)
    made.epilog = f"usage of each:\n{usages}\n{EPILOG}"
    return made


def _check(commands: "SubParsers[Parser]") -> Parser:
    made = commands.add_parser(
        "check",
        run="esplanade.scenery.cli:check",
        help="say what is wrong and where, or what the scene holds",
        description="Say what is wrong with a scene and where, or what it holds: its extent, "
        "layers,\ncells, and who gets where from its spawns. With --world, say the same of all "
        "scenes of a\nworld, and where their portals lead.",
    )
    _add_scene(made)
    made.add_argument(
        "--world",
        action="store_true",
        help="FILE is a world of several scenes, which portals join",
    )
    made.add_argument("--json", action="store_true", help="print it as JSON")
    _add_cell(made)
    return made


def _render(commands: "SubParsers[Parser]") -> Parser:
    made = commands.add_parser(
        "render",
        run="esplanade.scenery.cli:render",
        help="draw every layer: heights, reachability, classes, a path",
        description="Draw every layer of a scene as a body finds it: heights, "
        "reachability,\nthe five classes, and potential and path between two points.",
    )
    _add_scene(made)
    made.add_argument(
        "--out", metavar="DIR", type=Folder(), required=True, help="where the pictures go"
    )
    add_picture(made)
    made.add_argument(
        "--body",
        metavar="BODY",
        type=body,
        default="adult",
        help="adult, child, or measures in metres [default: adult]",
    )
    for option, names in (("from", "start"), ("to", "goal")):
        made.add_argument(
            f"--{option}",
            dest=names,
            metavar="PLACE|X,Y,Z",
            type=where,
            help="a place's name or a point in metres [default: two places far apart]",
        )
    _add_cell(made)
    return made


def _import(commands: "SubParsers[Parser]") -> Parser:
    made = commands.add_parser(
        "import",
        run="esplanade.scenery.cli:import_",
        help="make a scene of a mesh or of plans",
        description="Make a scene of a mesh or of plans. A mesh is kept beside it as SCENE.glb, "
        "which the\nscene names: keep the two together.",
    )
    made.add_argument(
        "mesh",
        metavar="FILE",
        nargs="+",
        help="a mesh (OBJ, glTF, GLB, PLY, STL, OFF, 3MF, IFC), a file or an address of the web; "
        "or plans, one for each storey (WKT, GeoJSON, JuPedSim, ROS map, DXF)",
    )
    made.add_argument(
        "--layer",
        metavar="NAME",
        action="append",
        default=[],
        help="a layer of a DXF whose lines are walls; may be repeated [default: all]",
    )
    made.add_argument(
        "--out",
        metavar="SCENE.json",
        type=OutputFile(".json"),
        required=True,
        help="the scene to write",
    )
    made.add_argument(
        "--up",
        choices=("y", "z"),
        help="the mesh's axis that is up [default: z for STL and 3MF, y for others]",
    )
    made.add_argument(
        "--recentre",
        action="store_true",
        help="move the middle of the mesh to the origin; the scene keeps by how much",
    )
    made.add_argument(
        "--scale",
        metavar="M",
        type=Number(1e-6, 1e6),
        default=1.0,
        help="metres in one unit of the mesh [default: 1]",
    )
    made.add_argument(
        "--unit",
        choices=tuple(UNITS),
        help="unit of a mesh or plan, whatever it says, instead of --scale",
    )
    made.add_argument("--name", metavar="TEXT", help="name of the scene [default: the mesh's]")
    made.add_argument(
        "--spawn",
        metavar="X,Y,Z",
        type=point,
        help="where people come in [default: amid the largest region that an adult can walk]",
    )
    made.add_argument(
        "--places",
        metavar="N",
        type=Whole(0, 64),
        default=8,
        help="places to spread over what can be reached [default: 8]",
    )
    add_picture(made)
    _add_cell(made)
    # The folder that the one of --out is renamed to afterwards, for callers from code.
    made.set_defaults(kept_in=None)
    return made


def _export(commands: "SubParsers[Parser]") -> Parser:
    made = commands.add_parser(
        "export",
        run="esplanade.scenery.exports.cli:export",
        help="write a scene for other programs: glTF, WKT, ROS map, PNG, SVG",
        description="Write a scene for other programs. The suffix of --out says in which form: "
        ".glb (a node\nfor each layer, walls, doors), .wkt (the ground of each storey), .yaml "
        "(a ROS map of each\nstorey, with its image), .png, .svg or .pdf (a plan of each storey, "
        "to scale).",
    )
    _add_scene(made)
    made.add_argument(
        "--out",
        metavar="FILE",
        type=OutputFile(),
        required=True,
        help="the file to write; storeys above the first have their number in its name",
    )
    made.add_argument(
        "--metres-per-cm",
        metavar="M",
        type=Number(0.01, 100.0),
        default=1.0,
        help="scale of a plan: metres in one centimetre of paper [default: 1, which is 1:100]",
    )
    _add_cell(made)
    return made


def _turn(commands: "SubParsers[Parser]") -> Parser:
    made = commands.add_parser(
        "turn",
        run="esplanade.scenery.cli:turn",
        help="write a scene turned about the vertical",
        description="Write a scene turned to the left about the middle of its bounds, with all its "
        "parts and\nits mesh. What can be walked stays as it was.",
    )
    _add_scene(made)
    made.add_argument(
        "--degrees", metavar="D", type=Number(-360.0, 360.0), required=True, help="the angle"
    )
    made.add_argument(
        "--out",
        metavar="SCENE.json",
        type=OutputFile(".json"),
        required=True,
        help="the scene to write",
    )
    made.add_argument("--name", metavar="TEXT", help="name of the scene [default: as it was]")
    return made


def _schema(commands: "SubParsers[Parser]") -> Parser:
    made = commands.add_parser(
        "schema",
        run="esplanade.scenery.cli:schema",
        help="write the JSON Schema of scenes, for editors",
        description='Write the JSON Schema of scenes. A scene that names it as "$schema" is '
        "completed and\nchecked by editors while it is written.",
    )
    made.add_argument(
        "--out",
        metavar="SCHEMA.json",
        type=OutputFile(".json"),
        required=True,
        help="the schema to write",
    )
    return made


def _add_scene(parser: Parser) -> None:
    parser.add_argument("scene", metavar="FILE", type=InputFile(), help="scene, a JSON file")


def _add_cell(made: Parser) -> None:
    made.add_argument(
        "--cell",
        metavar="M",
        type=Number(0.05, 2.0),
        default=DEFAULT_CELL_M,
        help=f"edge of a cell in metres [default: {DEFAULT_CELL_M}]",
    )
