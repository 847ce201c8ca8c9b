"""The options of `esplanade op preset` and `esplanade op group`."""

from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else

from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import InputFile, OutputFile, Text, Whole
from esplanade.operators.parts import (
    add_family,
    add_json,
    add_note,
    add_part,
    add_scope,
    assignment,
)
from esplanade.operators.scopes import guard


def add_preset_parts(commands: "SubParsers[Parser]") -> list[Parser]:
    """Add the commands, and return their parsers."""
    presets = add_family(
        commands, "preset", "Presets: values under a name, such as timid or rush-hour."
    )
    groups = add_family(
        commands,
        "group",
        "Groups: an actor has one at most for each purpose, such as kind:hurried.",
    )
    return [*_presets(presets), *_files(presets), *_groups(groups)]


def _presets(presets: "SubParsers[Parser]") -> list[Parser]:
    listed = add_part(presets, "preset_commands:list_", "list", "List all presets.")
    add_json(listed)
    show = add_part(
        presets,
        "preset_commands:show",
        "show",
        "Show the values of a preset beside the usual ones.",
        "preset show timid",
    )
    _add_name(show)
    _add_version(show)
    add_json(show)
    applied = add_part(
        presets,
        "preset_commands:apply",
        "apply",
        "Set the values of a preset for all actors, a group, or one.",
        "preset apply timid",
        "preset apply museum-guide --actor actor-3 --replace",
        "preset apply rush-hour --guard 'no_path_share>0.1/20s'",
    )
    _add_name(applied)
    _add_version(applied)
    add_scope(applied)
    applied.add_argument(
        "--replace", action="store_true", help="take other values of that scope away"
    )
    applied.add_argument(
        "--guard",
        metavar="CONDITION",
        type=guard,
        help="take it back if this holds, such as contacts_per_minute>3/10s",
    )
    add_note(applied)
    save = add_part(
        presets,
        "preset_commands:save",
        "save",
        "Keep values under a name, as its next version; the note says what they are good for.",
        'preset save calm risk_weight=20 speed_mps=1 --note "for the evening"',
        "preset save calm --from group:hurried",
    )
    _add_name(save)
    save.add_argument(
        "values", metavar="NAME=VALUE", nargs="*", type=assignment, help="such as risk_weight=12"
    )
    save.add_argument(
        "--from",
        dest="from_scope",
        metavar="SCOPE",
        type=Text(),
        help="what is set there: world, group:NAME or actor:ID",
    )
    add_note(save)
    delete = add_part(
        presets,
        "preset_commands:delete",
        "delete",
        "Forget what was saved under a name. What came along with the server stays.",
    )
    _add_name(delete)
    add_note(delete)
    return [listed, show, applied, save, delete]


def _files(presets: "SubParsers[Parser]") -> list[Parser]:
    export = add_part(
        presets,
        "preset_commands:export",
        "export",
        "Write a preset as TOML or JSON.",
        "preset export timid",
        "preset export timid --out timid.toml",
        "preset export timid --out timid.json",
    )
    _add_name(export)
    _add_version(export)
    export.add_argument(
        "--out",
        metavar="FILE",
        type=OutputFile(),
        help="a file that ends in .toml or .json [default: TOML to the standard output]",
    )
    taken = add_part(
        presets,
        "preset_commands:import_",
        "import",
        "Save presets from files, all of them or none.",
        "preset import timid.toml brisk.json",
    )
    taken.add_argument("files", metavar="FILE", nargs="+", type=InputFile(), help="TOML or JSON")
    add_note(taken)
    return [export, taken]


def _groups(groups: "SubParsers[Parser]") -> list[Parser]:
    listed = add_part(groups, "group_commands:list_", "list", "List all groups and their actors.")
    add_json(listed)
    put = add_part(
        groups,
        "group_commands:set_",
        "set",
        "Put actors into a group; each leaves the one that it had for that purpose.",
        "group set kind:hurried actor-1 actor-2",
        "set speed_mps=1.6 --group kind:hurried",
    )
    remove = add_part(
        groups,
        "group_commands:remove",
        "remove",
        "Take actors out of a group.",
        "group remove kind:hurried actor-1",
    )
    for part in (put, remove):
        part.add_argument("name", metavar="PURPOSE:NAME", type=Text(), help="the group")
        part.add_argument("actors", metavar="ACTOR", nargs="+", type=Text(), help="actors' ids")
        add_note(part)
    return [listed, put, remove]


def _add_name(parser: Parser) -> None:
    parser.add_argument("name", metavar="PRESET", type=Text(), help="the name of the preset")


def _add_version(parser: Parser) -> None:
    parser.add_argument(
        "--version", metavar="N", type=Whole(1), help="this version [default: the latest]"
    )
