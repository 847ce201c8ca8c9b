"""Rules for every command: help and faults load nothing heavy, and say all there is to say."""

import gc
import os
import subprocess
import sys
from argparse import SUPPRESS, Action
from collections.abc import Iterator
from pathlib import Path

import pytest

from esplanade.cli import COMMANDS, parser_of
from esplanade.commandline.parser import Parser
from esplanade.commandline.running import imported

HEAVY = {
    *("alembic", "argon2", "psycopg", "sqlalchemy"),
    *("asyncio", "matplotlib", "msgpack", "numba", "numpy", "PIL", "pydantic", "pydantic_settings"),
    *("rich", "scipy", "shtab", "structlog", "trimesh", "uvloop", "websockets"),
}

RUN = """
import sys
from esplanade.__main__ import main
sys.argv = ["esplanade", *sys.argv[1:]]
try:
    code = main()
except SystemExit as end:
    code = end.code
print("loaded:", *sorted({name.partition(".")[0] for name in sys.modules}), file=sys.stderr)
raise SystemExit(code)
"""


def parts(parser: Parser) -> Iterator[Parser]:
    """A command's parser, and those of its own commands."""
    yield parser
    for action in parser._actions:
        if isinstance(action.choices, dict):
            yield from (part for each in action.choices.values() for part in parts(each))


def explained(parser: Parser) -> Iterator[Action]:
    return (action for action in parser._actions if action.help != SUPPRESS)


EVERY = [part for name in COMMANDS for part in parts(parser_of(name))]

WRONG = [
    ("esplanade", "srve", "there is no command srve; did you mean serve?"),
    ("esplanade", "--verbose", "there is no option --verbose;"),
    ("esplanade serve", "serve --tickrate 3", "no option --tickrate; did you mean --tick-rate?"),
    ("esplanade serve", "serve --port many", "--port: 'many' is no whole number from 0 to 65535;"),
    ("esplanade serve", "serve --port", "--port: expected one argument;"),
    ("esplanade serve", "serve plaza.json", "plaza.json: not expected;"),
    ("esplanade serve", "serve --scene no.json", "--scene: no.json: cannot be read: No such file"),
    ("esplanade serve", "serve --walls pyproject.toml", "walls: they belong to a crowd"),
    ("esplanade serve", "serve --log-level loud", "there are debug, info, warning, error;"),
    ("esplanade serve", "serve --trajectories a.doc", "a.doc ends in none of .csv, .txt,"),
    ("esplanade serve", "serve --trajectories-hz 5", "it belongs to --trajectories"),
    ("esplanade serve", "serve --trajectories a.csv --trajectories-hz 3", "between the ticks"),
    ("esplanade run", "run README.md", "the following arguments are required: --out;"),
    ("esplanade run", "run --out a.csv", "give a SCENE, or --people"),
    ("esplanade run", "run no.json --out a.csv", "SCENE: no.json: cannot be read"),
    ("esplanade run", "run README.md --out a.csv --hz 7", "7 samples a second lie between"),
    (
        "esplanade evaluate",
        "evaluate README.md --trajectories a.doc",
        "ends in none of .csv,",
    ),
    (
        "esplanade scene render",
        "scene render README.md --out x --picture gif",
        "'gif' is no choice",
    ),
    ("esplanade bots", "bots --count 0", "--count: '0' is no whole number from 1 to 10000;"),
    ("esplanade bots", "bots --url ftp://x", "--url: url 'ftp://x': unknown scheme 'ftp'"),
    ("esplanade bots", "bots --linger 3", "linger: belongs to a replay"),
    ("esplanade bots", "bots --json no/x.json", "--json: there is no folder no;"),
    ("esplanade evaluate", "evaluate", "the following arguments are required: CROWD;"),
    ("esplanade evaluate", "evaluate no.csv", "CROWD: no.csv: cannot be read"),
    ("esplanade evaluate", "evaluate pyproject.toml --polcy x", "did you mean --policy?"),
    ("esplanade evaluate", "evaluate pyproject.toml --tune", "scores with --score-cache FILE"),
    ("esplanade evaluate", "evaluate pyproject.toml --set tempo", "'tempo' is not NAME=VALUE;"),
    ("esplanade scene", "scene", "the following arguments are required: COMMAND;"),
    ("esplanade scene", "scene chekc", "'chekc' is no choice; did you mean check?"),
    ("esplanade scene check", "scene check", "the following arguments are required: FILE;"),
    ("esplanade scene check", "scene check no.json", "FILE: no.json: cannot be read"),
    ("esplanade scene render", "scene render README.md --out x --body giant", "is no body;"),
    ("esplanade scene import", "scene import x.obj --out x.glb", "--out: x.glb is no .json file;"),
    ("esplanade gait render", "gait render --fps 33", "there are 10, 20, 25, 50;"),
    ("esplanade gait cycle", "gait cycle", "the following arguments are required: --out;"),
    ("esplanade demo", "demo --visitor 3", "no option --visitor; did you mean --visitors?"),
    ("esplanade demo", "demo --tick-rate 1", "--tick-rate: '1' is no whole number from 5 to 60;"),
    ("esplanade op", "op", "the following arguments are required: COMMAND;"),
    ("esplanade op user", "op user ad", "'ad' is no choice; did you mean add?"),
    ("esplanade op user add", "op user add olga --data x", "are required: --role;"),
    ("esplanade op user add", "op user add olga --role tunr", "'tunr' is no choice; did you mean"),
    ("esplanade op user add", "op user add olga --role tuner", "say where the data are: --data"),
    (
        "esplanade op user add",
        "op user add olga --role tuner --data x --token --password-stdin",
        "--token and --password-stdin: give one of them, not both",
    ),
    ("esplanade op user add", "op user add a --role viewer --data pyproject.toml", "not a folder;"),
    ("esplanade op token add", "op token add olga t --right door", "did you mean doors?"),
    ("esplanade op audit", "op audit --since yesterday", "'yesterday' is no span of time"),
    ("esplanade op audit", "op audit --csv --verify", "not allowed with argument --csv;"),
    ("esplanade op set", "op set risk_weight", "'risk_weight' is not of the form NAME=NUMBER;"),
    ("esplanade op set", "op set a=1 --guard people", "'people' is no condition such as people>40"),
    ("esplanade op preset", "op preset aply", "'aply' is no choice; did you mean apply?"),
    ("esplanade op schedule add", "op schedule add a=1", "one of the arguments --in --at"),
    ("esplanade op add", "op add --behaviour {", "this is no JSON"),
    ("esplanade op login", "op login", "give your account, or --with-token, and not both;"),
    ("esplanade op login", "op login olga secret", "secret: not expected;"),
    ("esplanade op warn", "op warn Eve", "the following arguments are required: --text;"),
    ("esplanade op ban", "op ban", "say whom: PERSON, --name or --address;"),
    ("esplanade op ban", "op ban Eve --for long", "'long' is no span of time such as 90s"),
    ("esplanade op watch", "op watch evnts", "'evnts' is no choice; did you mean events?"),
    ("esplanade op watch", "op watch series --kind join", "--kind: it is for events;"),
    ("esplanade data", "data", "the following arguments are required: COMMAND;"),
    ("esplanade data backup", "data backup x.tar --data x", "x.tar is no .zip file;"),
    ("esplanade data restore", "data restore no.zip --data x", "FILE: no.zip: cannot be read"),
    ("esplanade data forget", "data forget Eve", "say where the data are: --data DIR or"),
    ("esplanade completion", "completion csh", "'csh' is no choice; did you mean zsh?"),
]


def call(*words: str, **variables: str) -> tuple[int, str, list[str], set[str]]:
    """Exit code, output, lines of the error output, and the packages that were loaded."""
    done = subprocess.run(
        [sys.executable, "-c", RUN, *words],
        check=False,
        capture_output=True,
        text=True,
        cwd=Path(__file__).parents[2],
        env={**os.environ, **variables},
    )
    *said, loaded = done.stderr.splitlines()
    assert loaded.startswith("loaded: ")
    return done.returncode, done.stdout, said, set(loaded.split()[1:])


@pytest.mark.parametrize("parser", EVERY, ids=lambda parser: parser.prog)
def test_help_names_and_explains_every_option(parser: Parser) -> None:
    shown = " ".join(parser.format_help().split())
    assert parser.description
    for action in explained(parser):
        assert all(name in shown for name in action.option_strings)
        if not isinstance(action.choices, dict):
            assert action.help, f"{parser.prog} {action.dest} is not explained"


@pytest.mark.parametrize("words", ["--help", *(part.prog[10:] + " --help" for part in EVERY)])
def test_help_loads_nothing_heavy(words: str) -> None:
    code, shown, said, loaded = call(*words.split())
    assert (code, said) == (0, [])
    assert shown.startswith(f"usage: esplanade {words.removesuffix('--help')}".rstrip())
    assert not loaded & HEAVY


@pytest.mark.parametrize(("prog", "words", "fault"), WRONG, ids=[words for _, words, _ in WRONG])
def test_wrong_usage_is_one_line_and_loads_nothing_heavy(prog: str, words: str, fault: str) -> None:
    code, shown, said, loaded = call(*words.split())
    assert (code, shown) == (2, "")
    (line,) = said
    assert line.startswith(f"{prog}: ")
    assert fault in line
    assert line.endswith(f"see `{prog} --help`")
    assert not loaded & HEAVY


def test_a_variable_names_the_data_and_a_wrong_one_is_told() -> None:
    code, _, said, loaded = call("data", "forget", "Eve", ESPLANADE_DATA="pyproject.toml")
    assert code == 2
    (line,) = said
    assert "ESPLANADE_DATA: pyproject.toml is a file, not a folder" in line
    assert not loaded & HEAVY


def test_a_wrong_variable_is_one_line_and_loads_nothing_heavy() -> None:
    code, _, said, loaded = call("bots", ESPLANADE_BOTS_JOIN_RATE="fast")
    assert code == 2
    (line,) = said
    fault = "ESPLANADE_BOTS_JOIN_RATE: 'fast' is no number from 0.1 to 10000"
    assert line == f"esplanade bots: {fault}; see `esplanade bots --help`"
    assert not loaded & HEAVY


def test_an_import_leaves_the_collector_of_garbage_as_it_was() -> None:
    imported("esplanade.commandline.exit_codes:OK")
    assert gc.isenabled()
    gc.disable()
    try:
        imported("esplanade.commandline.exit_codes:OK")
        assert not gc.isenabled()
    finally:
        gc.enable()
