"""The effects of people's inputs on a zone, and what its frame tells of them."""

from collections.abc import Collection, Mapping
from itertools import compress

import numpy as np

from esplanade.planning import LayeredGrid
from esplanade.server.world.frame import Line, Tickets
from esplanade.server.world.inputs import (
    Attach,
    Detach,
    Follow,
    Join,
    Leave,
    MakeGesture,
    OfPerson,
    PeoplePlaced,
    Say,
    SetAway,
    SetLook,
    Stand,
    Steer,
    SteerMany,
    Watch,
)
from esplanade.server.world.looks import Looks
from esplanade.server.world.people import People
from esplanade.server.world.rules import Rules
from esplanade.server.world.spawning import Spawning
from esplanade.server.world.state import ACTOR, PERSON, State


class PersonInputs:
    """Takes inputs of people, one after the other, and gathers what is new by them in a tick."""

    def __init__(
        self,
        state: State,
        people: People,
        spawning: Spawning,
        grid: LayeredGrid,
        rules: Rules,
        looks: Looks,
    ) -> None:
        self._state = state
        self._people = people
        self._spawning = spawning
        self._grid = grid
        self._rules = rules
        self._looks = looks
        self._watched: dict[int, int] = {}
        self.begin_frame()

    def begin_frame(self) -> None:
        """Begin a tick, in which nothing is new yet."""
        self.joined: Tickets = []
        self.attached: Tickets = []
        self.detached: list[int] = []
        self.left: list[int] = []
        self.acks: dict[int, int] = {}
        self.chat: list[Line] = []
        self.gestures: dict[int, int] = {}

    @property
    def watched(self) -> Collection[int]:
        """The avatars of the actors whose plans somebody wants to see."""
        return self._watched.values()

    def save(self) -> dict[int, int]:
        """The actors' avatars that people watch, by the ids of these people."""
        return dict(self._watched)

    def load(self, watched: Mapping[int, int]) -> None:
        """Let people watch as when this was saved."""
        self._watched = {int(who): int(actor) for who, actor in watched.items()}

    def join(self, join: Join) -> None:
        """Give a newcomer an avatar, or somebody who comes from another zone the one of there.

        Raises
        ------
        ValueError
            An avatar with that id is here.
        NoRoomError
            There is no place left to stand.
        """
        place = self._spawning.place(join.at, join.anywhere)
        layer = self._grid.layer_at(place[:2], place[2])
        radius_m = self._rules.person_radius_m
        slot = self._state.add(PERSON, join.name, place, layer, radius_m, join.id)
        self._looks.wear(slot, join.look)
        self._people.stop(slot)
        self.joined.append((join.ticket, int(self._state.ids[slot])))

    def take(self, item: OfPerson, slot: int) -> None:
        """Take in what a person who is in that slot wants."""
        match item:
            case Steer():
                self._people.steer(slot, item)
                self.acks[item.id] = item.seq
            case Follow():
                self._people.follow(slot, item)
                self.acks[item.id] = item.seq
            case Stand():
                self._people.stop(slot)
            case Attach():
                self._state.away[slot] = False
                self.attached.append((item.ticket, item.id))
            case Detach():
                self._people.stop(slot)
                self._state.away[slot] = True
                self._look_no_more(item.id)
                self.detached.append(item.id)
            case Leave():
                self._people.stop(slot)
                self._look_no_more(item.id)
                self.left.append(item.id)
                self._state.remove(item.id)
            case Say():
                self.chat.append(Line(item.id, item.text))
            case Watch():
                self._watch(item)
            case SetAway():
                self._state.away[slot] = item.away
            case MakeGesture():
                self.gestures[item.id] = item.gesture
            case SetLook():
                self._looks.wear(slot, item.look)

    def take_many(self, item: SteerMany | PeoplePlaced) -> None:
        """Take in what becomes of many people; those who are gone are left out."""
        if isinstance(item, SteerMany):
            self._steer(item)
        else:
            self._put(item)

    def _steer(self, wish: SteerMany) -> None:
        slots = self._state.slots_of(wish.ids)
        here = slots >= 0
        self._people.steer_many(slots[here], wish.directions_rad[here], wish.speeds_mps[here])
        self.acks.update(zip(compress(wish.ids, here), compress(wish.seqs, here), strict=True))

    def _put(self, placed: PeoplePlaced) -> None:
        slots = self._state.slots_of(placed.ids)
        here = slots >= 0
        places = np.array(placed.places, dtype=np.float64).reshape(-1, 3)
        self._people.put(slots[here], places[here])

    def gone(self, avatars: list[int]) -> None:
        """Actors' avatars have left the world: nobody watches them any more."""
        self.left += avatars
        gone = set(avatars)
        self._watched = {who: one for who, one in self._watched.items() if one not in gone}

    def _watch(self, item: Watch) -> None:
        self._watched.pop(item.id, None)
        actor, state = item.actor_id, self._state
        if actor is not None and actor in state and state.kinds[state.slot(actor)] == ACTOR:
            self._watched[item.id] = actor

    def _look_no_more(self, avatar_id: int) -> None:
        self._watched.pop(avatar_id, None)
        self.attached = [(ticket, one) for ticket, one in self.attached if one != avatar_id]
