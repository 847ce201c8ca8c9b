"""Turns commands on people into the facts that they want, checked against those who are here."""

from dataclasses import dataclass
from typing import Any, Final, assert_never

from esplanade.protocol.commands import (
    Announce,
    Ban,
    Facts,
    HideLine,
    Kick,
    Mute,
    QuietZone,
    SettleReport,
    SetWordFilter,
    SlowMode,
    Unban,
    WalkOut,
    Warn,
)
from esplanade.server.console.moderation import Moderation
from esplanade.server.console.refusals import RefusedError
from esplanade.server.moderation.bans import MOST_BANS, MOST_PATTERNS, check_pattern, network
from esplanade.server.moderation.chat_rules import MOST_ZONES, ZONE
from esplanade.server.moderation.state import PEOPLE
from esplanade.server.world.zone import Zone

ToPerson = Warn | Mute | Kick | WalkOut
OnPeople = (
    ToPerson
    | Announce
    | Ban
    | Unban
    | HideLine
    | SlowMode
    | SetWordFilter
    | QuietZone
    | SettleReport
)
MODERATING: Final = (
    *(Announce, Warn, Mute, Kick, WalkOut, Ban, Unban, HideLine),
    *(SlowMode, SetWordFilter, QuietZone, SettleReport),
)
REVERTIBLE: Final = (Ban, Unban, SlowMode, SetWordFilter, QuietZone, SettleReport)
"""Commands that can be taken back, as their facts stay as they are."""
KINDS: Final = ("ban", "report", "line", "quiet_zone", PEOPLE)
"""The kinds of subjects whose facts are told here."""


@dataclass(frozen=True)
class Wanted:
    """The facts that a command wants, and the name of the person whom it is about."""

    facts: Facts
    person: str | None = None


class ModerationIntents:
    """Checks commands on people."""

    def __init__(self, people: Moderation, zone: Zone) -> None:
        self._people = people
        self._zone = zone

    def fact(self, subject: str, field: str) -> Any:
        """The present value of a field of a subject of one of `KINDS`."""
        return self._people.state.fact(subject, field)

    def wanted(  # noqa: PLR0911 (one for each command)
        self, command: OnPeople, pending: Facts
    ) -> Wanted:
        """The facts that a command wants; `pending` are those of commands before it.

        Raises
        ------
        RefusedError
            It cannot be had.
        """
        match command:
            case Announce():
                reached = len(self.addressed(command))
                return Wanted({PEOPLE: {"announced": command.text, "reached": reached}})
            case Warn() | Mute() | Kick() | WalkOut():
                return self._to_person(command)
            case Ban():
                return self._ban(command, pending)
            case Unban():
                return self._unban(command)
            case HideLine():
                return self._line(command)
            case SlowMode():
                return Wanted({PEOPLE: {"slow_mode_s": command.seconds or None}})
            case SetWordFilter():
                rule = {"words": list(command.words), "action": command.action}
                return Wanted({PEOPLE: {"word_filter": rule if command.words else None}})
            case QuietZone():
                return self._quiet_zone(command, pending)
            case SettleReport():
                return self._report(command)
        assert_never(command)

    def _to_person(self, command: ToPerson) -> Wanted:
        name = self._people.name_of(command.person)
        if name is None:
            raise _nobody(command.person)
        subject = f"person:{command.person}"
        match command:
            case Warn():
                return Wanted({subject: {"warned": True}}, name)
            case Mute():
                return Wanted({subject: {"muted_s": command.seconds}}, name)
            case Kick():
                return Wanted({subject: {"kicked": True}}, name)
            case WalkOut():
                return Wanted({subject: {"walked_out": True}}, name)
        assert_never(command)

    def _ban(self, command: Ban, pending: Facts) -> Wanted:
        decided, coming = self._people.state, sum(subject.startswith("ban:") for subject in pending)
        if decided.bans.holding + coming >= MOST_BANS:
            raise RefusedError.of("full", f"{MOST_BANS} bans are the most there can be")
        known = None
        if command.person is not None:
            known = self._people.known(command.person)
            if known is None:
                raise _nobody(command.person)
        if command.until_s is not None and command.until_s * 1e6 <= decided.now_us():
            raise RefusedError.of("invalid", "until_s is over already", "until_s")
        if command.address is not None:
            try:
                network(command.address)
            except ValueError as error:
                raise RefusedError.of("invalid", str(error), "address") from None
        if command.name_pattern is not None:
            self._check_pattern(command.name_pattern, coming)
        person = known.name if known is not None else command.name_pattern
        return Wanted({f"ban:{decided.next_ban()}": {"banned": True}}, person)

    def _check_pattern(self, pattern: str, coming: int) -> None:
        try:
            check_pattern(pattern)
        except ValueError as error:
            raise RefusedError.of("invalid", str(error), "name_pattern") from None
        if "*" in pattern and self._people.state.bans.patterns + coming >= MOST_PATTERNS:
            text = f"{MOST_PATTERNS} patterns with * are the most there can be"
            raise RefusedError.of("full", text, "name_pattern")

    def _unban(self, command: Unban) -> Wanted:
        ban = self._people.state.bans.get(command.ban)
        if ban is None or ban.lifted:
            text = f"there is no ban {command.ban}, or it is lifted already"
            raise RefusedError.of("unknown_ban", text, "ban", ban=command.ban)
        return Wanted({f"ban:{command.ban}": {"banned": False}}, ban.name_pattern)

    def _line(self, command: HideLine) -> Wanted:
        line, numbers = self._people.state.chat.get(command.line), self._people.lines
        if line is None and not numbers.first <= command.line <= numbers.latest:
            text = f"there is no line {command.line}"
            raise RefusedError.of("unknown_line", text, "line", line=command.line)
        name = None if line is None else line.name
        return Wanted({f"line:{command.line}": {"hidden": True}}, name)

    def _quiet_zone(self, command: QuietZone, pending: Facts) -> Wanted:
        rules, subject = self._people.state.rules, f"{ZONE}{command.name}"
        if command.remove:
            if command.name not in rules.quiet and subject not in pending:
                text = f"there is no quiet zone {command.name!r}"
                raise RefusedError.of("unknown_zone", text, "name", name=command.name)
            return Wanted({subject: {"area": None}})
        names = {*rules.quiet, command.name}
        names.update(one.removeprefix(ZONE) for one in pending if one.startswith(ZONE))
        if len(names) > MOST_ZONES:
            raise RefusedError.of("full", f"{MOST_ZONES} quiet zones are the most there can be")
        polygon = [list(point) for point in command.polygon or ()]
        return Wanted({subject: {"area": {"polygon": polygon, "storey_m": command.storey_m}}})

    def _report(self, command: SettleReport) -> Wanted:
        report = self._people.state.inbox.get(command.report)
        if report is None:
            text = f"there is no report {command.report}"
            raise RefusedError.of("unknown_report", text, "report", report=command.report)
        return Wanted({f"report:{command.report}": {"state": "done"}}, report.name)

    def addressed(self, command: Announce) -> list[int]:
        """The people whom an announcement reaches.

        Raises
        ------
        RefusedError
            The actor whom they are to be near is not there.
        """
        centre = None
        if command.near_actor is not None:
            avatar = self._zone.avatar_of(command.near_actor)
            centre = None if avatar is None else self._people.where(avatar)
            if centre is None:
                text = f"there is no actor {command.near_actor}"
                raise RefusedError.of("unknown_actor", text, "near_actor", actor=command.near_actor)
        return self._people.within(
            storey_m=command.storey_m,
            polygon=command.polygon,
            centre=centre,
            radius_m=command.radius_m,
        )


def _nobody(person: int) -> RefusedError:
    return RefusedError.of(
        "unknown_person", f"there is no person {person}", "person", person=person
    )
