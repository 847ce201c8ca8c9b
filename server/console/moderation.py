"""Moderation as the console needs it: whatever serves people carries it out."""

from typing import Protocol

from esplanade.protocol.commands import Announce, Command, Facts, Kick, Mute
from esplanade.server.console.refusals import RefusedError

MODERATING = (Announce, Kick, Mute)


class Moderation(Protocol):
    """Those who serve people carry out what moderators want of them."""

    def name_of(self, person: int) -> str | None:
        """Return the name of a person in the world, by the avatar's id; None if there is none."""

    def muted_s(self, person: int) -> float:
        """For how many seconds nobody hears a person yet."""

    def announce(self, text: str) -> int:
        """Say something to everyone; returns to how many."""

    def kick(self, person: int, text: str) -> None:
        """End a person's connection, and say why; the avatar is gone."""

    def mute(self, person: int, seconds: float, text: str) -> None:
        """Let nobody hear a person for a time, and say so; 0 ends it."""


def wanted_of_people(command: Command, moderation: Moderation) -> Facts:
    """Return the facts that a command of `MODERATING` wants of people.

    Raises
    ------
    RefusedError
        There is no such person.
    """
    if isinstance(command, Announce):
        return {"people": {"announced": command.text}}
    assert isinstance(command, Kick | Mute)  # noqa: S101
    if moderation.name_of(command.person) is None:
        text = f"there is no person {command.person}"
        raise RefusedError.of("unknown_person", text, "person", person=command.person)
    subject = f"person:{command.person}"
    if isinstance(command, Kick):
        return {subject: {"kicked": True}}
    return {subject: {"muted_s": command.seconds}}


def moderate(command: Command, moderation: Moderation) -> None:
    """Carry out a command of `MODERATING`."""
    match command:
        case Announce():
            moderation.announce(command.text)
        case Kick():
            moderation.kick(command.person, command.text)
        case Mute():
            moderation.mute(command.person, command.seconds, command.text)
