"""Tells subscribers what is new on their channels; a message that several want is made once."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, cast

from esplanade.protocol.commands import full_id
from esplanade.server.live import layers, one_actor, trips
from esplanade.server.live.bulletin import Notice
from esplanade.server.live.subscriber import Subscriber
from esplanade.server.live.subscriptions import ACTOR, ActorWish, EventsWish, LayersWish
from esplanade.server.live.tap import Probe

if TYPE_CHECKING:
    from esplanade.server.live.live import Live


class Telling:
    """Makes the messages of all channels but the map's blocks."""

    def __init__(self, live: Live) -> None:
        self._live = live
        self._contacts: list[tuple[int, int]] = []
        self._steady: dict[str, tuple[int, Probe]] = {}
        """Probes that go on for as long as somebody wants them: how often, and the probe."""

    def contacts(self, pairs: list[tuple[int, int]]) -> None:
        """Keep contacts that have begun until the next beat."""
        self._contacts += pairs

    def second(self, tick: int) -> None:
        """Tell the values of a second."""
        series = self._live.series
        told = {"at_us": series.at_us, "tick": tick, "step_s": 1, "values": series.latest}
        self._publish("series", lambda _: told)

    def notice(self, notice: Notice) -> None:
        """Tell of a change, and draw a line in all series."""
        change, event = notice.change, notice.event
        if change is not None:
            self._publish("changes", lambda _: {"change": change})
            if change.get("op") != "mark":
                self._mark(notice.at_us, str(change.get("op")), change)
        if event is not None and event["kind"] == "mark":
            self._mark(notice.at_us, str(event["text"]), event["arguments"])
        if notice.about is not None:
            self._publish("changes", lambda _: {"about": notice.about})

    def beat(self, beat: int, found: Mapping[str, Any]) -> None:
        """Tell all that is new since the last beat; `found` are the latest results of probes."""
        live = self._live
        self._tell_events()
        self._tell_contacts()
        for subscriber in live.subscribers:
            if subscriber.ready("map", beat):
                subscriber.offer_map()
            if found.get(layers.PROBE) is not None and subscriber.ready("map.layers", beat):
                wish = cast(LayersWish, subscriber.wishes["map.layers"])
                subscriber.post(layers.told(found[layers.PROBE], wish, live.map))
            self._tell_of_actors(subscriber, found, beat)
        self._set_probes()

    def _tell_events(self) -> None:
        events, self._live.events.new = self._live.events.new, []
        if not events:
            return
        made: dict[tuple[Any, ...], str | None] = {}
        for subscriber in self._live.subscribers:
            wish = subscriber.wishes.get("events")
            if not isinstance(wish, EventsWish):
                continue
            kinds = None if wish.kinds is None else frozenset(wish.kinds)
            key = kinds, subscriber.names
            if key not in made:
                told = [
                    event.told(names=subscriber.names)
                    for event in events
                    if kinds is None or event.kind in kinds
                ]
                made[key] = json.dumps({"channel": "events", "events": told}) if told else None
            text = made[key]
            if text is not None:
                subscriber.post(text)

    def _tell_contacts(self) -> None:
        pairs, self._contacts = self._contacts, []
        if not pairs:
            return
        feed, told = self._live.map, []
        for actor, other in pairs:
            place, avatar = feed.place(actor), feed.avatars.get(actor)
            if place is None or avatar is None:
                continue
            known = feed.avatars.get(other)
            by_actor = known is not None and known.actor is not None
            whom = known.actor if known is not None and by_actor else other
            told.append([*place, avatar.actor, whom, "actor" if by_actor else "person"])
        self._publish("contacts", lambda _: {"tick": feed.tick, "pairs": told})

    def _tell_of_actors(self, subscriber: Subscriber, found: Mapping[str, Any], beat: int) -> None:
        live = self._live
        for channel, wish in list(subscriber.wishes.items()):
            if not isinstance(wish, ActorWish):
                continue
            actor = str(full_id(channel.removeprefix(ACTOR)))
            avatar_id = live.map.avatar_of(actor)
            if avatar_id is None:
                if channel not in subscriber.missing and live.map.tick:
                    subscriber.missing.add(channel)
                    subscriber.tell(_no_actor(channel, actor))
                continue
            subscriber.missing.discard(channel)
            seen = found.get(ACTOR + actor)
            if seen is not None and subscriber.ready(channel, beat):
                told = one_actor.told(
                    actor,
                    avatar_id,
                    seen,
                    live.map,
                    live.reasons,
                    slice_s=live.zone.slice_s,
                    names=subscriber.names,
                )
                subscriber.tell({**told, "channel": channel})

    def _set_probes(self) -> None:
        """Let the zone be asked for what somebody wants, and for nothing else."""
        live = self._live
        makers: dict[str, tuple[int, Callable[[int], Probe]]] = {
            trips.PROBE: (trips.EVERY, lambda _: trips.progress_probe())
        }
        for subscriber in live.subscribers:
            for channel, wish in subscriber.wishes.items():
                if isinstance(wish, LayersWish):
                    _want(makers, layers.PROBE, self._every(wish.hz), layers.layers_probe)
                elif isinstance(wish, ActorWish):
                    actor = str(full_id(channel.removeprefix(ACTOR)))
                    avatar_id = live.map.avatar_of(actor)
                    if avatar_id is not None:
                        _want(
                            makers,
                            ACTOR + actor,
                            self._every(wish.hz),
                            partial(one_actor.actor_probe, avatar_id),
                        )
        wanted = {name: every for name, (every, _) in makers.items()}
        if wanted == {name: every for name, (every, _) in self._steady.items()}:
            return
        self._steady = {
            name: self._steady[name]
            if self._steady.get(name, (0,))[0] == every
            else (every, make(every))
            for name, (every, make) in makers.items()
        }
        passing = {name: each for name, each in live.tap.probes.items() if each.once}
        live.tap.probes = {**passing, **{name: each for name, (_, each) in self._steady.items()}}

    def _every(self, hz: float) -> int:
        """Ticks between two messages."""
        return max(1, round(1.0 / (hz * self._live.zone.tick_s)))

    def _mark(self, at_us: int, text: str, by: Mapping[str, Any]) -> None:
        self._live.marks.append({"at_us": at_us, "text": text, "account": by.get("account")})

    def _publish(self, channel: str, message: Callable[[bool], Mapping[str, Any]]) -> None:
        """Send one message to all who subscribe to a channel; it is given whether with names."""
        made: dict[bool, str] = {}
        for subscriber in self._live.subscribers:
            if channel in subscriber.wishes:
                names = subscriber.names
                if names not in made:
                    made[names] = json.dumps({"channel": channel, **message(names)})
                subscriber.post(made[names])


def _want(
    makers: dict[str, tuple[int, Callable[[int], Probe]]],
    name: str,
    every: int,
    make: Callable[[int], Probe],
) -> None:
    """Want a probe; of several wishes the most frequent counts."""
    if name not in makers or every < makers[name][0]:
        makers[name] = every, make


def _no_actor(channel: str, actor: str) -> dict[str, Any]:
    text = f"there is no actor {actor}"
    fault = {"code": "unknown_actor", "text": text, "path": [], "arguments": {"actor": actor}}
    return {"channel": channel, "faults": [fault]}
