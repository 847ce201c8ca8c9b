"""Carries out what commands want of people: in the store, and for those who are connected."""

from collections.abc import Sequence

from esplanade.protocol.commands import (
    Announce,
    Ban,
    Command,
    Facts,
    HideLine,
    Kick,
    Mute,
    WalkOut,
    Warn,
)
from esplanade.server.console.moderation import Moderation
from esplanade.server.console.moderation_intents import KINDS, ModerationIntents
from esplanade.server.console.planned import Planned
from esplanade.server.console.refusals import RefusedError
from esplanade.server.moderation import bans


class Moderating:
    """Does for people, or against them, what was planned."""

    def __init__(self, people: Moderation, intents: ModerationIntents) -> None:
        self._people = people
        self._intents = intents

    async def carry_out(self, planned: Sequence[Planned], account: str | None) -> None:
        """Write what is to last into the store, then do what commands want of people.

        Raises
        ------
        StoreError
            Nothing is done.
        """
        new: dict[int, bans.Ban] = {}
        facts: Facts = {}
        for one in planned:
            chosen = {
                subject: fields
                for subject, fields in one.after.items()
                if subject.partition(":")[0] in KINDS
            }
            facts.update(chosen)
            if isinstance(one.command, Ban):
                (subject,) = chosen
                ban = self._made(one.command, int(subject.partition(":")[2]), account)
                new[ban.id] = ban
        if facts:
            await self._people.state.decide(facts, new.values(), account)
        for one in planned:
            self._act(one.command)
            self._turn_out(one)

    def _act(self, command: Command) -> None:
        people = self._people
        match command:
            case Announce():
                people.announce(command.text, self._still_addressed(command))
            case Warn():
                people.warn(command.person, command.text)
            case Mute():
                people.mute(command.person, command.seconds, command.text)
            case Kick():
                people.kick(command.person, command.text)
            case WalkOut():
                people.walk_out(command.person, command.text)
            case HideLine():
                people.hide(command.line)

    def _still_addressed(self, command: Announce) -> list[int]:
        try:
            return self._intents.addressed(command)
        except RefusedError:  # the actor has gone since it was checked
            return []

    def _turn_out(self, planned: Planned) -> None:
        """Send those out whom a new ban is of, or one that holds again."""
        for subject, fields in planned.after.items():
            kind, _, name = subject.partition(":")
            ban = self._people.state.bans.get(int(name)) if kind == "ban" else None
            if ban is not None and fields.get("banned"):
                command = planned.command
                person = command.person if isinstance(command, Ban) else None
                self._people.turn_out(ban, person)

    def _made(self, command: Ban, number: int, account: str | None) -> bans.Ban:
        """The ban that a command wants."""
        digests: tuple[str, ...] = () if command.token_digest is None else (command.token_digest,)
        name, address = command.name_pattern, command.address
        known = None if command.person is None else self._people.known(command.person)
        if known is not None:
            if "token" in command.by:
                digests += known.digests
            if "name" in command.by and name is None:
                name = known.wished.replace("*", "")
            if "address" in command.by and address is None:
                address = known.address
        until_us = None if command.until_s is None else round(command.until_s * 1e6)
        now_us = self._people.state.now_us()
        return bans.Ban(
            number, command.text, until_us, now_us, account, digests, name or None, address
        )
