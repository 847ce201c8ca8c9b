"""`esplanade serve`: the command line, made from the fields of the settings."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from pydantic import ValidationError
from pydantic.fields import FieldInfo

from esplanade.server.loading import LoadingError
from esplanade.server.main import serve
from esplanade.server.settings import ENV_PREFIX, ServerSettings

EXIT_USAGE = 2
EXIT_FAILED = 1


def run(argv: Sequence[str]) -> int:
    """Run the server as the command line says; returns the exit code."""
    given = vars(parser().parse_args(argv))
    try:
        settings = ServerSettings(**given)
    except ValidationError as error:
        return _refuse(_faults(error, given), EXIT_USAGE)
    try:
        serve(settings)
    except LoadingError as error:
        return _refuse(str(error), EXIT_USAGE)
    except OSError as error:
        ports = f"{settings.host}:{settings.port}, {settings.private_host}:{settings.private_port}"
        return _refuse(f"cannot listen on {ports}: {error.strerror or error}", EXIT_FAILED)
    return 0


def parser() -> argparse.ArgumentParser:
    """One option for every setting, in the groups that the settings name."""
    made = argparse.ArgumentParser(
        prog="esplanade serve",
        usage="esplanade serve [options]",
        description="Run a world for people and actors.",
        epilog=f"Every option can also be given as an environment variable: --tick-rate is "
        f"{ENV_PREFIX}TICK_RATE. The command line wins.",
        argument_default=argparse.SUPPRESS,
        allow_abbrev=False,
    )
    groups: dict[str, argparse._ArgumentGroup] = {}
    for name, field in ServerSettings.model_fields.items():
        extra = _extra(field)
        group = groups.get(extra["group"])
        if group is None:
            group = groups[extra["group"]] = made.add_argument_group(extra["group"])
        group.add_argument(
            _option(name), dest=name, metavar=_metavar(field), help=_help(field, extra["unit"])
        )
    return made


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")


def _extra(field: FieldInfo) -> dict[str, str]:
    extra = field.json_schema_extra
    return {key: str(value) for key, value in extra.items()} if isinstance(extra, dict) else {}


def _metavar(field: FieldInfo) -> str:
    kind: Any = field.annotation
    if get_origin(kind) is Literal:
        return "|".join(get_args(kind))
    if Path in get_args(kind):
        return "FILE"
    return {int: "N", float: "X"}.get(kind, "TEXT")


def _help(field: FieldInfo, unit: str) -> str:
    facts = [unit] if unit else []
    least, most = _bound(field, "ge", "gt"), _bound(field, "le", "lt")
    if least is not None and most is not None:
        facts.append(f"{least:.10g} to {most:.10g}")
    if str(field.default) not in ("None", ""):
        facts.append(f"default {field.default}")
    text = field.description or ""
    return (f"{text} [{', '.join(facts)}]" if facts else text).replace("%", "%%")


def _bound(field: FieldInfo, *names: str) -> float | None:
    for item in field.metadata:
        for name in names:
            value = getattr(item, name, None)
            if value is not None:
                return float(value)
    return None


def _faults(error: ValidationError, given: dict[str, Any]) -> str:
    lines = []
    for fault in error.errors(include_url=False, include_input=False):
        name = str(fault["loc"][0]) if fault["loc"] else ""
        text = fault["msg"].removeprefix("Value error, ")
        where = _option(name) if name in given else f"{ENV_PREFIX}{name.upper()}"
        lines.append(f"{where}: {text}" if name else text)
    return "\n".join(lines)


def _refuse(text: str, code: int) -> int:
    for line in text.splitlines():
        print(f"esplanade serve: {line}", file=sys.stderr)
    return code
