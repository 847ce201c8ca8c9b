"""Plans of watched actors, as messages to their watchers."""

import numpy as np

from esplanade.actors import Explanation
from esplanade.protocol import Outcome, Reason
from esplanade.protocol.messages import Blocker, Circle, Plan, Tour


def plan(tick: int, actor: int, explanation: Explanation) -> Plan:
    """An actor's explanation as it goes over the wire, to the millimetre."""
    goal = explanation.goal
    return Plan(
        tick=tick,
        id=actor,
        reason=Reason(explanation.reason),
        behaviour=explanation.behaviour,
        goal=None if goal is None else tuple(np.round(goal, 3).tolist()),
        path=np.round(explanation.path, 3).tolist(),
        people=[
            [
                Circle(x=x, y=y, z=z, radius=radius)
                for x, y, z, radius in np.round(circles, 3).tolist()
            ]
            for circles in explanation.people
        ],
        since_s=round(explanation.since_s, 3),
        blocker=blocker(explanation),
        outcome=None if explanation.outcome is None else Outcome(explanation.outcome),
        in_the_way=in_the_way(explanation),
        tour=tour(explanation),
    )


def tour(explanation: Explanation) -> Tour | None:
    """Return the tour of a guide as it goes over the wire."""
    led = explanation.tour
    if led is None:
        return None
    followers = sorted(who for who in led.followers if isinstance(who, int))
    return Tour(stops=list(led.stops), next=led.next, followers=followers)


def blocker(explanation: Explanation) -> Blocker | None:
    """Return a blocker as it goes over the wire; the ids are those of avatars."""
    held = explanation.blocker
    if held is None:
        return None
    avatar = held.id if isinstance(held.id, int) else None
    door = held.id if isinstance(held.id, str) else None
    return Blocker(kind=held.kind, id=avatar, door=door, away=held.away_m)


def in_the_way(explanation: Explanation) -> Blocker | None:
    """Return whom a trip did not end at its goal for; the ids are those of avatars."""
    by = explanation.in_the_way
    if by is None:
        return None
    avatar = by.id if isinstance(by.id, int) else None
    door = by.id if isinstance(by.id, str) else None
    return Blocker(kind=by.kind, id=avatar, door=door)
