"""Makes events of what ticks and notices tell."""

from typing import Any, Final

from esplanade.actors.state import Reason
from esplanade.server.live.bulletin import Notice
from esplanade.server.live.encounters import moves_toward
from esplanade.server.live.events import Events, Party
from esplanade.server.live.map_feed import MapFeed
from esplanade.server.live.reasons import Reasons
from esplanade.server.live.tap import Avatar, Tick

STOP_S: Final = 5.0
"""An actor that is held for longer than this has stopped."""
NAMING: Final = frozenset({"report", "command", "mark"})
"""Events whose text may have names of people in it."""


class Happenings:
    """Notes what happens, as events."""

    def __init__(self, feed: MapFeed, reasons: Reasons, events: Events) -> None:
        self._feed = feed
        self._reasons = reasons
        self._events = events
        self._stood = 0
        """Ticks without a plan since the last second in which any were told."""
        self._late: int | None = None
        """Late ticks at that time."""
        self._told_us = 0

    def before(self, tick: Tick) -> None:
        """Take in those who leave in a tick, before the map forgets them; and what they said."""
        frame, at_us = tick.frame, tick.at_us
        for line in frame.events.chat:
            who = self._party(line.id)
            self._add(tick, "chat", "{who}: ", who=who, place=self._place(line.id), said=line.text)
        for gone in frame.left:
            avatar = self._feed.avatars.get(gone)
            if avatar is not None and avatar.actor is None:
                self._events.add(
                    "leave",
                    at_us,
                    frame.tick,
                    "{who} left",
                    who=party_of(avatar),
                    place=self._place(gone),
                )

    def after(self, tick: Tick, contacts: list[tuple[int, int]]) -> None:
        """Take in what else happens in a tick; `contacts` are those that begin in it."""
        frame = tick.frame
        for each in tick.entered:
            if each.actor is None:
                who, place = party_of(each), self._place(each.id)
                self._add(tick, "join", "{who} came in", who=who, place=place)
        for name, is_open in frame.events.doors.items():
            words = f"the door {name} is {'open' if is_open else 'closed'}"
            self._add(tick, "door", words, arguments={"door": name, "open": is_open})
        for actor, other in contacts:
            self._contact(tick, actor, other)
        self._stood += frame.actors_stood
        if tick.at_us - self._told_us >= 1_000_000:
            self._trouble(tick)

    def _trouble(self, tick: Tick) -> None:
        """Note ticks that failed or were late since the last second, each as one event."""
        late = 0 if self._late is None else tick.late - self._late
        for kind, count, words in (
            ("plan_failure", self._stood, "nothing was planned, and the actors stood"),
            ("late_tick", late, "ticks began late"),
        ):
            if count:
                self._add(tick, kind, f"{words}: {count}", arguments={"ticks": count})
        self._stood, self._late, self._told_us = 0, tick.late, tick.at_us

    def stops(self, at_us: int) -> None:
        """Note who has been held for long; call it at each beat."""
        for who, timeline in self._reasons.long_stops(STOP_S):
            span = timeline.now
            held = span.blocker
            no_path = span.reason is Reason.NO_PATH
            arguments: dict[str, Any] = {
                "reason": span.reason.name.lower(),
                "seconds": round(self._reasons.seconds(timeline), 1),
            }
            words, other = "{who} finds no path" if no_path else "{who} has stopped", None
            if held is not None:
                arguments["blocker"] = {"kind": held.kind, "id": held.id, "away_m": held.away_m}
                if held.kind in {"person", "actor"} and isinstance(held.id, int):
                    other = self._party(held.id)
                    words += ", held by {other}"
                elif held.id is not None:
                    words += f", held by the {held.kind} {held.id}"
            kind = "no_path" if no_path else "stop"
            self._events.add(
                kind,
                at_us,
                self._feed.tick,
                words,
                who=self._party(who),
                other=other,
                place=self._place(who),
                arguments=arguments,
            )

    def notice(self, notice: Notice) -> None:
        """Note what operators and others have made known."""
        if notice.change is not None and notice.change.get("op") != "mark":
            change = notice.change
            told = ("number", "account", "op", "subjects", "note")
            self._events.add(
                "pace" if change.get("op") == "pace" else "command",
                notice.at_us,
                self._feed.tick,
                f"{change.get('account') or 'an operator'}: {change.get('op')}",
                arguments={name: change.get(name) for name in told},
                # Schedules and guards say in their notes that it was they.
                said=f", {change['note']}" if change.get("note") else "",
                private=True,
            )
        if notice.event is not None:
            event = notice.event
            words, said = "", event["text"]
            if event["kind"] == "report":
                words, said = "{who} reports {other}", f": {said}" if said else ""
            self._events.add(
                event["kind"],
                notice.at_us,
                self._feed.tick,
                words,
                who=self._named(event["who"]),
                other=self._named(event["other"]),
                place=event["place"],
                arguments=event["arguments"],
                said=said,
                private=event["kind"] in NAMING,
            )

    def _contact(self, tick: Tick, actor: int, other: int) -> None:
        toward = [
            name
            for name, one, two in (("actor", actor, other), ("other", other, actor))
            if moves_toward(self._feed, one, two)
        ]
        words = "{who} and {other} touched"
        if toward == ["actor"]:
            words = "{who} walked into {other}"
        elif toward == ["other"]:
            words = "{other} walked into {who}"
        self._add(
            tick,
            "contact",
            words,
            who=self._party(actor),
            other=self._party(other),
            place=self._place(actor),
            arguments={"toward": toward},
        )

    def _add(self, tick: Tick, kind: str, words: str, **more: Any) -> None:
        self._events.add(kind, tick.at_us, tick.frame.tick, words, **more)

    def _place(self, who: int) -> tuple[float, float, float] | None:
        return self._feed.place(who)

    def _party(self, who: int) -> Party | None:
        avatar = self._feed.avatars.get(who)
        return None if avatar is None else party_of(avatar)

    def _named(self, who: str | int | None) -> Party | None:
        """The one whom a notice names, by the id of an avatar or of an actor."""
        if isinstance(who, int):
            return self._party(who) or Party(who, "somebody who is gone", person=True)
        return None if who is None else Party(who, who, person=False)


def party_of(avatar: Avatar) -> Party:
    """An avatar as somebody who takes part in events."""
    if avatar.actor is None:
        return Party(avatar.id, avatar.name, person=True)
    return Party(avatar.actor, avatar.name, person=False)
