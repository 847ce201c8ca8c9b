"""Commands on groups that have a purpose."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from esplanade.protocol.commands.fields import TAG, Actors, BaseCommand


class SetGroup(BaseCommand):
    """Put actors into a group, or take them out of it.

    An actor has one group at most for each purpose: it leaves the one that it had.
    """

    op: Literal["set_group"]
    group: Annotated[
        str, Field(pattern=f"^{TAG}:{TAG}$", description="`purpose:name`, such as `kind:hurried`.")
    ]
    actors: Actors
    remove: bool = False
