"""Reads a Dockerfile: its stages, and the steps of each in their order.

It knows what this project's file uses, and refuses all else by the line: no step is passed over.
"""

import json
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

_STEPS: Final = frozenset({"RUN", "COPY", "ENV", "WORKDIR", "USER", "VOLUME"})
_SETTINGS: Final = frozenset({"ENTRYPOINT", "CMD", "HEALTHCHECK", "EXPOSE", "STOPSIGNAL"})


class DockerfileError(Exception):
    """The file has something that is not understood here; the message names the line."""


@dataclass(frozen=True)
class Step:
    """An instruction that changes the image, or how later ones are run."""

    word: str
    text: str
    """Everything after the word, on one line."""
    line: int


@dataclass
class Stage:
    """One stage of a build."""

    base: str
    """The image that it begins with."""
    name: str
    steps: list[Step] = field(default_factory=list)
    settings: dict[str, str] = field(default_factory=dict)
    """ENTRYPOINT, CMD, HEALTHCHECK and the like: the last of each counts."""


def read_dockerfile(path: Path) -> list[Stage]:
    """The stages of a file, in their order.

    Raises
    ------
    DockerfileError
        An instruction is unknown, or comes before the first FROM.
    OSError
        The file cannot be read.
    """
    stages: list[Stage] = []
    for number, text in _lines(path.read_text()):
        word, _, rest = text.partition(" ")
        rest = rest.strip()
        if word == "FROM":
            parts = rest.split()
            named = parts[2] if len(parts) == 3 and parts[1].upper() == "AS" else ""
            stages.append(Stage(parts[0], named))
        elif not stages:
            raise DockerfileError(f"{path}:{number}: {word} comes before FROM")
        elif word in _STEPS:
            stages[-1].steps.append(Step(word, rest, number))
        elif word in _SETTINGS:
            stages[-1].settings[word] = rest
        else:
            raise DockerfileError(f"{path}:{number}: {word!r} is not understood")
    return stages


def words_of(text: str) -> list[str]:
    """The words of a command in the form of a JSON list.

    Raises
    ------
    DockerfileError
        It is in another form.
    """
    try:
        words = json.loads(text)
    except ValueError:
        words = None
    if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
        raise DockerfileError(f"{text!r} is no command in the form of a list")
    return words


def health_command(text: str) -> list[str]:
    """The command of a HEALTHCHECK, without its options."""
    return words_of(re.sub(r"^(--\S+\s+)*CMD\s+", "", text))


def _lines(text: str) -> list[tuple[int, str]]:
    """Instructions with the numbers of their first lines; lines that go on are joined."""
    found: list[tuple[int, str]] = []
    going_on = ""
    first = 0
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("#") or not line.strip():
            continue
        first = first if going_on else number
        going_on += line.strip()
        if going_on.endswith("\\"):
            going_on = going_on[:-1].rstrip() + " "
            continue
        found.append((first, going_on))
        going_on = ""
    return found
