"""One table of settings: options, variables, and the pydantic classes, which must agree."""

from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import pytest
from pydantic_settings import BaseSettings

from esplanade.bots import options as bots
from esplanade.bots.settings import BotsSettings
from esplanade.commandline.errors import UsageError
from esplanade.commandline.fields import made
from esplanade.commandline.readers import Choice, Flag, Folder, InputFile, Number, OutputFile, Whole
from esplanade.commandline.settings import Setting, Settings, given_settings, settings_parser
from esplanade.server import options as server
from esplanade.server.settings import ServerSettings

CLASSES: list[tuple[Settings, type[BaseSettings]]] = [
    (server.SETTINGS, ServerSettings),
    (bots.SETTINGS, BotsSettings),
]


def fits(given: Any) -> None:
    if given.get("low", 1) > given.get("high", 9):
        raise ValueError("low: must not be above high")


TABLE = Settings(
    "HALL_",
    {
        "heights": {
            "low": Setting("the low end, 5 % off", Whole(0, 9), 1, "m"),
            "high": Setting("the high end", Whole(0, 9), 9, "m"),
        },
        "words": {"colour": Setting("the colour", Choice("red", "blue"), "red")},
        "doors": {"open": Setting("whether the doors are open", Flag(), default=False)},
        "files": {"json_file": Setting("where it goes", OutputFile(), option="json")},
    },
    fits,
)


def read(*words: str) -> dict[str, Any]:
    parser = settings_parser("hall", TABLE, run="nowhere:run", description="A hall.")
    return given_settings(parser.parse_args(words), TABLE)


def refusal(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    with pytest.raises(SystemExit, match="2"):
        read(*words)
    shown = capsys.readouterr()
    assert shown.out == ""
    (line,) = shown.err.splitlines()
    return line


@pytest.fixture(autouse=True)
def _no_variables(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("HALL_LOW", "HALL_COLOUR", "hall_low"):
        monkeypatch.delenv(name, raising=False)


def test_only_what_is_given_is_there(tmp_path: Path) -> None:
    assert read() == {}
    target = str(tmp_path / "x.json")
    assert read("--low=3", "--json", target) == {"low": 3, "json_file": Path(target)}


@pytest.mark.parametrize("variable", ["HALL_LOW", "hall_low"])
def test_variables_count_less_than_options(monkeypatch: pytest.MonkeyPatch, variable: str) -> None:
    monkeypatch.setenv(variable, "4")
    assert read() == {"low": 4}
    assert read("--low", "5") == {"low": 5}


@pytest.mark.parametrize(
    ("words", "value"),
    [
        ("--open", {"open": True}),
        ("--open=no", {"open": False}),
        ("--open yes", {"open": True}),
        ("", {}),
    ],
)
def test_a_flag_means_yes_alone(words: str, value: dict[str, bool]) -> None:
    assert read(*words.split()) == value


def test_a_flag_is_read_from_a_variable(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("HALL_OPEN", "1")
    assert read() == {"open": True}
    monkeypatch.setenv("HALL_OPEN", "maybe")
    assert "HALL_OPEN: 'maybe' is neither yes nor no" in refusal(capsys)


def test_help_has_groups_units_ranges_and_defaults(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="0"):
        read("--help")
    shown = " ".join(capsys.readouterr().out.split())
    assert "heights: --low N the low end, 5 % off [m, 0 to 9, default 1]" in shown
    assert "--colour red|blue the colour [default red]" in shown
    assert "--json FILE where it goes" in shown
    assert "--open [yes|no] whether the doors are open files:" in shown


def test_faults_name_the_option_or_the_variable(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    see = "see `hall --help`"
    fault = "'12' is no whole number from 0 to 9"
    assert refusal(capsys, "--low=12") == f"hall: --low: {fault}; {see}"
    assert refusal(capsys, "--color=red") == (
        f"hall: there is no option --color; did you mean --colour? {see}"
    )
    assert refusal(capsys, "--low=5", "--high=2") == f"hall: low: must not be above high; {see}"
    monkeypatch.setenv("HALL_COLOUR", "bleu")
    assert refusal(capsys) == f"hall: HALL_COLOUR: 'bleu' is no choice; did you mean blue? {see}"
    monkeypatch.setenv("HALL_LOW", "12")
    assert refusal(capsys) == f"hall: HALL_LOW: {fault}; {see}"


@pytest.mark.parametrize(("table", "kind"), CLASSES)
def test_table_and_class_have_the_same_settings_of_the_same_types(
    table: Settings, kind: type[BaseSettings]
) -> None:
    names = [name for group in table.groups.values() for name in group]
    assert list(kind.model_fields) == names
    assert kind.model_config["env_prefix"] == table.prefix
    for name, field in kind.model_fields.items():
        kinds = get_args(field.annotation) or (field.annotation,)
        reader = table.setting(name).read
        if get_origin(field.annotation) is Literal:
            assert isinstance(reader, Choice)
            assert reader.choices == kinds
        else:
            assert (int in kinds) == isinstance(reader, Whole), name
            assert (float in kinds) == (type(reader) is Number), name
            assert (Path in kinds) == isinstance(reader, InputFile | OutputFile | Folder), name
            assert (bool in kinds) == isinstance(reader, Flag), name


@pytest.mark.parametrize(("table", "kind"), CLASSES)
def test_defaults_are_within_their_own_limits(table: Settings, kind: type[BaseSettings]) -> None:
    """Pydantic does not look at defaults, but for values that are given."""
    defaults = {
        name: setting.default
        for group in table.groups.values()
        for name, setting in group.items()
        if setting.default is not None and not name.startswith(("speedup", "linger"))
    }
    assert kind(**defaults).model_dump() == kind().model_dump()


def test_what_pydantic_refuses_is_put_into_words() -> None:
    with pytest.raises(UsageError, match=r"^tick_rate: Input should be less than or equal to 60$"):
        made(ServerSettings, {"tick_rate": 100})
    with pytest.raises(UsageError, match=r"^walls: they belong to a crowd, but none is given$"):
        made(ServerSettings, {"walls": Path("x")})
