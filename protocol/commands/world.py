"""Commands on the world that all share."""

from __future__ import annotations

from typing import Literal

from esplanade.protocol.commands.fields import BaseCommand, Place


class MoveDoor(BaseCommand):
    """Open or close a door, once nobody stands in its way."""

    op: Literal["move_door"]
    door: Place
    open: bool
