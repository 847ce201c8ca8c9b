"""The changes of a fork against its recording, as options say them, checked by the models."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, Self

from pydantic import ValidationError

from esplanade.actors import ActorParameters
from esplanade.commandline.parser import suggestion
from esplanade.planning import Scene
from esplanade.planning.scene.scene_file import SceneError, read_scene
from esplanade.server.roster import Roster, RosterError, read_roster
from esplanade.server.whatif.errors import WhatIfError

People = Literal["recorded", "reacting"]


@dataclass(frozen=True)
class Changes:
    """Everything that is other in a fork; without any it is the recorded world."""

    values: Mapping[str, float | int] = field(default_factory=dict)
    """Parameters of all actors, also of those who come in later."""
    roster: Roster | None = None
    """The actors that walk instead of the recorded ones."""
    doors: Mapping[str, bool] = field(default_factory=dict)
    """Whether doors are open, by name."""
    scene: Scene | None = None
    """The scene in which all begins anew; None for the recorded state in its own scene."""

    @classmethod
    def read(
        cls,
        values: Sequence[str],
        roster: Path | None,
        doors: Sequence[str],
        scene: Path | None,
        recorded: Scene,
    ) -> Self:
        """The changes that texts like `risk_weight=20` and `gate=closed` name, and files.

        Raises
        ------
        WhatIfError
            There is no such parameter or door, a value is out of range, or a file is broken.
        """
        other = None if scene is None else _scene(scene)
        try:
            walking = None if roster is None else read_roster(roster)
        except RosterError as error:
            raise WhatIfError(f"--roster: {error}") from None
        return cls(
            dict(_value(text) for text in values),
            walking,
            dict(_door(text, other or recorded) for text in doors),
            other,
        )

    @property
    def texts(self) -> list[str]:
        """Each change in a few words."""
        told = [f"{name} = {value:g}" for name, value in self.values.items()]
        if self.roster is not None:
            told.append(f"{len(self.roster.actors)} actors of another roster")
        told += [
            f"{name}: {'open' if is_open else 'closed'}" for name, is_open in self.doors.items()
        ]
        if self.scene is not None:
            told.append(f"scene {self.scene.name}")
        return told


def _scene(path: Path) -> Scene:
    try:
        return read_scene(path)
    except OSError as error:
        raise WhatIfError(f"--scene: {path}: {error.strerror or error}") from None
    except SceneError as error:
        raise WhatIfError(f"--scene: {error}") from None


def _value(text: str) -> tuple[str, float | int]:
    name, given, value = text.partition("=")
    if name not in ActorParameters.model_fields:
        near = suggestion(name, ActorParameters.model_fields)
        raise WhatIfError(f"--set: {name!r} is no parameter of actors{near}")
    if not given:
        raise WhatIfError(f"--set: {text!r} has no value: write {name}=NUMBER")
    try:
        made = ActorParameters.model_validate({name: value})
    except ValidationError as error:
        for fault in error.errors(include_url=False):
            if fault["loc"] == (name,):
                raise WhatIfError(f"--set: {name}: {fault['msg']}, not {value!r}") from None
        # Whether it goes together with others of each actor is found out where these are known.
        return name, float(value)
    found: float | int = getattr(made, name)
    return name, found


def _door(text: str, scene: Scene) -> tuple[str, bool]:
    name, _, state = text.rpartition("=")
    if state not in ("open", "closed"):
        raise WhatIfError(f"--door: {text!r} is not NAME=open or NAME=closed")
    names = [door.name for door in scene.doors]
    if name not in names:
        known = f"it has {', '.join(names)}" if names else "it has none"
        raise WhatIfError(f"--door: the scene has no door {name!r}; {known}")
    return name, state == "open"
