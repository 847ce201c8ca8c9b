"""Inputs of people until the next tick: movements, gestures, doors, comings and goings."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from esplanade.server.metrics import Metrics
from esplanade.server.world.inputs import (
    Attach,
    Detach,
    Input,
    Leave,
    MakeGesture,
    MoveDoor,
    Movement,
    SetAway,
    SetLook,
    Stand,
    SteerMany,
    Watch,
)


class PendingInputs:
    """Inputs that wait for the next tick: at most one movement for each person, the latest.

    The number of people and that of doors bound all of it.
    """

    def __init__(self, metrics: Metrics, unread: Callable[[], int] = lambda: 0) -> None:
        """`unread` counts movements that wait elsewhere, and that only the next tick brings."""
        self._metrics = metrics
        self._comings: list[Attach | Detach | Leave | Stand] = []
        self._movements: dict[int, Movement] = {}
        self._steers: dict[int, tuple[int, float, float]] = {}
        self._doors: dict[str, MoveDoor] = {}
        self._watches: dict[int, Watch] = {}
        self._presences: dict[int, SetAway] = {}
        self._gestures: dict[int, MakeGesture] = {}
        self._looks: dict[int, SetLook] = {}
        metrics.gauge(
            "movements_waiting",
            "Movements that wait for the next tick",
            lambda: self._number + unread(),
        )

    def come(self, *comings: Attach | Detach | Leave | Stand) -> None:
        """Let the zone know that somebody comes, goes or stands; in this order."""
        self._comings += comings

    def move(self, movement: Movement) -> None:
        """Keep a movement; it takes the place of an earlier one."""
        if self._drop(movement.id):
            self._metrics.traffic.movements_superseded += 1
        self._movements[movement.id] = movement

    def steer(self, wishes: Mapping[int, tuple[int, float, float]]) -> None:
        """Keep movements by the avatar's id; they take the places of earlier ones."""
        before = self._number
        if self._movements:
            for avatar_id in self._movements.keys() & wishes.keys():
                del self._movements[avatar_id]
        self._steers.update(wishes)
        self._metrics.traffic.movements_superseded += before + len(wishes) - self._number

    def move_door(self, wish: MoveDoor) -> None:
        """Keep a wish for a door; the latest wins."""
        self._doors[wish.name] = wish

    def watch(self, wish: Watch) -> None:
        """Keep which actor somebody watches; the latest wins."""
        self._watches[wish.id] = wish

    def be_away(self, wish: SetAway) -> None:
        """Keep whether somebody is away; the latest wins."""
        self._presences[wish.id] = wish

    def make_gesture(self, wish: MakeGesture) -> None:
        """Keep a gesture; the latest wins."""
        self._gestures[wish.id] = wish

    def wear(self, wish: SetLook) -> None:
        """Keep how somebody wants to look; the latest wins."""
        self._looks[wish.id] = wish

    def stand(self, avatar_id: int) -> None:
        """Let an avatar stand; a movement that waits is void."""
        self._drop(avatar_id)
        self.come(Stand(avatar_id))

    def forget(self, avatar_id: int) -> None:
        """Forget what somebody wants whose connection has ended."""
        self._drop(avatar_id)
        self._watches.pop(avatar_id, None)
        self._presences.pop(avatar_id, None)
        self._gestures.pop(avatar_id, None)
        self._looks.pop(avatar_id, None)

    @property
    def _number(self) -> int:
        return len(self._movements) + len(self._steers)

    def _drop(self, avatar_id: int) -> bool:
        """Forget a movement; whether there was one."""
        gone = self._movements.pop(avatar_id, None), self._steers.pop(avatar_id, None)
        return gone != (None, None)

    def drain(self, lines: Sequence[Input], joins: Sequence[Input], *, still: bool) -> list[Input]:
        """Return everything for the next tick, with the lines of chat and those who join.

        For a `still` tick, in which nobody moves, movements wait for the next one.
        """
        # A line is said before its speaker goes.
        inputs: list[Input] = [*lines, *self._comings, *joins]
        if not still:
            inputs.extend(self._movements.values())
            if self._steers:
                numbers, directions, speeds = zip(*self._steers.values(), strict=True)
                inputs.append(
                    SteerMany(
                        tuple(self._steers),
                        numbers,
                        np.array(directions, dtype=np.float64),
                        np.array(speeds, dtype=np.float64),
                    )
                )
            self._movements, self._steers = {}, {}
        inputs.extend(self._doors.values())
        inputs.extend(self._watches.values())
        inputs.extend(self._presences.values())
        inputs.extend(self._gestures.values())
        inputs.extend(self._looks.values())
        self._comings, self._doors, self._watches = [], {}, {}
        self._presences, self._gestures, self._looks = {}, {}, {}
        return inputs
