"""The options of commands that belong to no part alone: `serve`, `demo`, `op` and others."""

from typing import Final

from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import SEED_LIMIT, Whole
from esplanade.commandline.settings import Setting, settings_parser
from esplanade.operators.options import add_parts
from esplanade.server import options as server
from esplanade.server.offline import options as offline
from esplanade.server.operating import options as operating

COMPLETION_EPILOG: Final = """\
to have it from now on:
  bash  esplanade completion bash > ~/.local/share/bash-completion/completions/esplanade
  zsh   esplanade completion zsh > FOLDER/_esplanade, where FOLDER is in $fpath
  fish  esplanade completion fish > ~/.config/fish/completions/esplanade.fish
"""


_PORT: Final = Whole(1, 65535)
_AMOUNT: Final = Whole(0, 500)
_DEMO: Final = {
    "port": Setting("port for people", _PORT, 8080),
    "private_port": Setting("port for health and metrics", _PORT, 8081),
    "actors": Setting("number of actors", Whole(0, 1000), 12),
    "visitors": Setting(
        "number of wandering bots; with --crowd its people come instead, again and again",
        _AMOUNT,
        6,
    ),
    "seed": Setting("seed of everything drawn by chance", Whole(0, SEED_LIMIT), 1),
}


def demo() -> Parser:
    """The demo's own options, and without words those of the server."""
    others = {
        name: setting
        for group in server.SETTINGS.groups.values()
        for name, setting in group.items()
        if name not in _DEMO
    }
    settings = server.SETTINGS._replace(groups={"demo": _DEMO, "server": others})
    made = settings_parser(
        "esplanade demo",
        settings,
        run="esplanade.demo:run",
        explained=(*_DEMO.keys(), "scene", "world", "crowd"),
        description="Run the demo world with actors, and with a few visitors made of code.",
        epilog="""\
examples:
  esplanade demo                             the gallery
  esplanade demo --scene house.ifc           a building, a plan (DXF, WKT, ROS map, ..) or a scene
  esplanade demo --world scenes/town.json    two scenes, and a portal between them
  esplanade demo --crowd obsmat.txt          recorded people among actors

All other options go to the server: see `esplanade serve --help`.""",
    )
    made.set_defaults(**{name: setting.default for name, setting in _DEMO.items()})
    return made


def serve() -> Parser:
    """The options of the server; its scene may be made of a mesh or a plan first."""
    made = server.parser()
    made.set_defaults(run="esplanade.opening:serve")
    return made


def run() -> Parser:
    """The options of a world without a server, likewise."""
    made = offline.parser()
    made.set_defaults(run="esplanade.opening:run")
    return made


def op() -> Parser:
    """Add the commands on the store of a server, and those on a server that runs."""
    return operating.parser(add_parts)


def completion() -> Parser:
    """The shell whose completion is wanted."""
    made = Parser(
        "esplanade completion",
        run="esplanade.completion:run",
        description="Print what completes `esplanade` on a shell's command line.",
        epilog=COMPLETION_EPILOG,
    )
    made.add_argument("shell", choices=("bash", "zsh", "fish"), help="the shell")
    return made
