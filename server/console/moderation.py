"""Moderation as the console needs it: whatever serves people carries it out."""

from collections.abc import Iterable, Sequence
from typing import Any, Protocol

from esplanade.server.moderation.areas import Place
from esplanade.server.moderation.bans import Ban
from esplanade.server.moderation.state import ModerationState


class Known(Protocol):
    """A person, by whatever they can be known again."""

    @property
    def name(self) -> str:
        """The name that others see."""

    @property
    def wished(self) -> str:
        """The name that they asked for."""

    @property
    def address(self) -> str: ...

    @property
    def digests(self) -> tuple[str, ...]:
        """Of the resume tokens of their seat."""


class NumberedLines(Protocol):
    """The numbers of the lines of chat that were said so far."""

    @property
    def first(self) -> int: ...

    @property
    def latest(self) -> int: ...


class Moderation(Protocol):
    """Those who serve people carry out what moderators want of them."""

    @property
    def state(self) -> ModerationState:
        """All that moderators have decided."""

    @property
    def lines(self) -> NumberedLines: ...

    def name_of(self, person: int) -> str | None:
        """Return the name of a person in the world, by the avatar's id; None if there is none."""

    def known(self, person: int) -> Known | None:
        """A person in the world, or one who has left within the last minutes."""

    def where(self, avatar_id: int) -> Place | None:
        """The place of an avatar; None if it is not in the world."""

    def within(
        self,
        *,
        storey_m: float | None,
        polygon: Sequence[tuple[float, float]] | None,
        centre: Place | None,
        radius_m: float,
    ) -> list[int]:
        """People on a storey, in a polygon, or around a centre; all of them without."""

    def details(self, person: int) -> dict[str, Any]:
        """The facts of a person in the world that operators are shown beside place and name."""

    def muted_s(self, person: int) -> float:
        """For how many seconds nobody hears a person yet."""

    def announce(self, text: str, people: Iterable[int]) -> int:
        """Say something to these people; returns to how many."""

    def warn(self, person: int, text: str) -> None:
        """Say something to one person, as a warning."""

    def kick(self, person: int, text: str) -> None:
        """End a person's connection, and say why; the avatar is gone."""

    def walk_out(self, person: int, text: str) -> None:
        """Let a person's avatar walk to a place of arrival, and then go."""

    def turn_out(self, ban: Ban, person: int | None = None) -> int:
        """Send out whoever a ban is of, and this person; returns how many."""

    def hide(self, line: int) -> None:
        """Let a line be shown no more by anybody's client."""

    def mute(self, person: int, seconds: float, text: str) -> None:
        """Let nobody hear a person for a time, and say so; 0 ends it."""
