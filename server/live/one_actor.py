"""One actor as an inspector shows it: where it is, what it is about to do, and why."""

from typing import Any, NamedTuple

import numpy as np

from esplanade.actors import Explanation
from esplanade.actors.traces import Decided
from esplanade.protocol.snapshot import HEADING_RAD, SPEED_MPS
from esplanade.server.live.map_feed import MapFeed
from esplanade.server.live.reasons import Reasons
from esplanade.server.live.subscriptions import ACTOR
from esplanade.server.live.tap import Probe
from esplanade.server.live.told_traces import told_cost, told_path
from esplanade.server.world.zone import Zone


class Seen(NamedTuple):
    """The facts that a zone tells of an actor."""

    why: Explanation
    decided: Decided | None


def actor_probe(avatar_id: int, every: int) -> Probe:
    """Let the zone be asked to explain an actor, every so many ticks."""

    def see(zone: Zone) -> Seen:
        return Seen(zone.explain(avatar_id), zone.decided(avatar_id))

    return Probe(see, every)


def told(
    actor: str,
    avatar_id: int,
    seen: Seen,
    feed: MapFeed,
    reasons: Reasons,
    *,
    slice_s: float,
    names: bool,
) -> dict[str, Any]:
    """The message of a subscription to an actor, with what the zone has explained."""
    why, decided = seen
    row = int(np.searchsorted(feed.ids, avatar_id))
    record, spec = feed.records[row], feed.specs.get(actor)
    x, y, z = feed.place(avatar_id) or (0.0, 0.0, 0.0)
    return {
        "channel": f"{ACTOR}{actor}",
        "tick": feed.tick,
        "id": avatar_id,
        "x": x,
        "y": y,
        "z": z,
        "heading": round(int(record["heading"]) * HEADING_RAD, 3),
        "speed": round(int(record["speed"]) * SPEED_MPS, 2),
        "reason": why.reason.name.lower(),
        "since_s": round(why.since_s, 2),
        "blocker": reasons.told_blocker(why.blocker, names=names),
        "outcome": None if why.outcome is None else why.outcome.name.lower(),
        "in_the_way": reasons.told_in_the_way(why.in_the_way, names=names),
        "behaviour": {} if spec is None else spec.behaviour.model_dump(mode="json"),
        "goal": None if why.goal is None else [round(v, 2) for v in why.goal],
        "path": np.round(why.path, 2).tolist(),
        "circles": [np.round(each, 2).tolist() for each in why.people],
        "cost": None if decided is None else told_cost(decided.taken),
        "previous": None if decided is None else told_path(decided.previous, slice_s),
    }
