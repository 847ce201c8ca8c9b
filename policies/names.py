"""The names of policies from outside: a file or module and a class there, or an entry point."""

import hashlib
import importlib
import importlib.util
import json
import sys
from collections.abc import Callable, Iterable
from importlib.machinery import SourceFileLoader
from importlib.metadata import entry_points
from pathlib import Path
from types import ModuleType
from typing import Any, Final, cast
from urllib.parse import urlsplit

SOCKET: Final = "tcp://"
GROUP: Final = "esplanade.policies"
"""The group of entry points by which an installed package offers policies."""


def is_outside(name: str) -> bool:
    """Whether a name is that of a policy from outside, such as `my_policy.py:MyPolicy`."""
    return ":" in name or name in {point.name for point in entry_points(group=GROUP)}


def place_of(name: str) -> str:
    """The file or module and the class of a policy, `FILE.py:CLASS` or `MODULE:CLASS`."""
    if ":" in name:
        return name
    (point, *_) = entry_points(group=GROUP, name=name)
    return point.value


def label_of(name: str) -> str:
    """The short name of a policy for tables, pictures and files."""
    if name.startswith(SOCKET):
        parts = urlsplit(name)
        return parts.path.strip("/") or f"tcp-{parts.port}"
    return name.rpartition(":")[2] if ":" in name else name


def address_of(name: str) -> tuple[str, int] | None:
    """Host and port of a policy that is asked over a socket; None of one with a process of its own.

    Raises
    ------
    ValueError
        The address is not like `tcp://127.0.0.1:5555` or `tcp://127.0.0.1:5555/name`.
    """
    if not name.startswith(SOCKET):
        return None
    parts = urlsplit(name)
    if not parts.hostname or not parts.port:
        raise ValueError(f"{name} is not like tcp://127.0.0.1:5555/name")
    return parts.hostname, parts.port


def own_options(name: str, options: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """The options of one policy, as keywords: those of all, and those given as `MyPolicy.gain`."""
    found = {}
    for option, value in options:
        owner, _, keyword = option.rpartition(".")
        if owner in ("", label_of(name)):
            found[keyword] = value
    return found


def option_value(text: str) -> Any:
    """The value of an option: JSON, or else the text itself. A list becomes a tuple.

    Raises
    ------
    ValueError
        It is a JSON object, or has one inside.
    """
    try:
        return frozen(json.loads(text))
    except json.JSONDecodeError:
        return text


def frozen(value: Any) -> Any:
    """A value of JSON with tuples instead of lists, so that options can be compared and kept.

    Raises
    ------
    ValueError
        It is an object, or has one inside.
    """
    match value:
        case dict():
            raise ValueError(f"{value} is an object; give its parts as options of their own")
        case list():
            return tuple(map(frozen, value))
    return value


def digest_of_policy(name: str) -> str:
    """SHA-256 of the source file of a policy from outside; empty where there is no such file.

    A policy that reads further files, or is asked over a socket, is to be given another score cache
    when it changes.
    """
    if name.startswith(SOCKET):
        return ""
    place, _, _ = place_of(name).rpartition(":")
    path = Path(place)
    if path.suffix != ".py":
        try:
            found = importlib.util.find_spec(place)
        except (ImportError, ValueError):
            return ""
        path = Path((found and found.origin) or "")
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""


def maker_of(place: str) -> Callable[..., Any]:
    """The class, or function, that makes a policy, `FILE.py:CLASS` or `MODULE:CLASS`.

    Modules beside the file can be imported by it.

    Raises
    ------
    LookupError
        There is no such file, module or class.
    """
    where, _, name = place.rpartition(":")
    if not where.endswith(".py"):
        try:
            module = importlib.import_module(where)
        except ModuleNotFoundError as error:
            if error.name is None or not where.startswith(error.name):
                raise
            raise LookupError(f"there is no module {where}") from None
    else:
        path = Path(where)
        if not path.is_file():
            raise LookupError(f"there is no file {where}")
        sys.path.insert(0, str(path.resolve().parent))
        loader = SourceFileLoader(path.stem, str(path))
        module = ModuleType(path.stem)
        module.__file__ = str(path)
        sys.modules[path.stem] = module
        loader.exec_module(module)
    maker = getattr(module, name, None)
    if maker is None:
        raise LookupError(f"{where} has no class {name}")
    return cast(Callable[..., Any], maker)
