"""Finds the class of a scenario in a file of its user, and the lines of its errors."""

import importlib.util
import inspect
import sys
import traceback
from pathlib import Path
from types import ModuleType
from typing import Final

from pydantic import ValidationError

from esplanade.bots.scenario import Scenario
from esplanade.commandline.fields import in_words

_CALLED: Final = ("on_join", "on_tick")


def load_scenario(place: str) -> type[Scenario]:
    """The class of `FILE:CLASS`.

    Raises
    ------
    ValueError
        The file cannot be read or run, or it has no such scenario; the message says where and why.
    """
    file, _, name = place.rpartition(":")
    path = Path(file).resolve()
    module = _run(path, file)
    kind = getattr(module, name, None)
    if kind is None:
        known = [
            each.__name__
            for each in vars(module).values()
            if isinstance(each, type) and issubclass(each, Scenario) and each is not Scenario
        ]
        hint = f"it has {', '.join(known)}" if known else "it has no scenario"
        raise ValueError(f"{file}: there is no class {name}; {hint}")
    if not (isinstance(kind, type) and issubclass(kind, Scenario)):
        raise ValueError(  # noqa: TRY004 (all faults of the file are told as one kind)
            f"{file}: {name} is no subclass of esplanade.bots.Scenario"
        )
    for method in _CALLED:
        if not inspect.iscoroutinefunction(getattr(kind, method)):
            raise ValueError(f"{file}: {name}.{method} must be `async def`")
    return kind


def where(error: BaseException, kind: type[Scenario]) -> str:
    """The file and line of the scenario's error, and what it was."""
    return _told(error, Path(inspect.getfile(kind)))


def _run(path: Path, shown: str) -> ModuleType:
    """The module that the file makes; other files of its folder can be imported there."""
    name = f"esplanade_scenario_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise ValueError(f"{shown}: is no Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    folder = str(path.parent)
    if folder not in sys.path:
        sys.path.insert(0, folder)
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:  # noqa: BLE001 (anything may go wrong there)
        raise ValueError(_told(error, path)) from None
    return module


def _told(error: BaseException, path: Path) -> str:
    if isinstance(error, SyntaxError) and error.filename:
        return f"{Path(error.filename).name}:{error.lineno}: SyntaxError: {error.msg}"
    frames = traceback.extract_tb(error.__traceback__)
    inside = [frame for frame in frames if Path(frame.filename).resolve() == path.resolve()]
    line = f":{inside[-1].lineno}" if inside else ""
    text = in_words(error) if isinstance(error, ValidationError) else str(error).partition("\n")[0]
    return f"{path.name}{line}: {type(error).__name__}" + (f": {text}" if text else "")
