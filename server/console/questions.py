"""Answers to questions of operators about a zone, as plain data."""

from typing import Any

from esplanade.actors import ActorParameters, ActorSpec
from esplanade.actors.behaviour_spec import BEHAVIOUR_SPEC
from esplanade.actors.state import Reason
from esplanade.protocol.commands import COMMAND, ZONE
from esplanade.server.console.console import Console
from esplanade.server.console.pacing import told
from esplanade.server.console.refusals import RefusedError
from esplanade.server.world.state import PERSON


def schema() -> dict[str, Any]:
    """The schemas of parameters, behaviours and commands, from which forms can be made."""
    return {
        "parameters": ActorParameters.model_json_schema(),
        "behaviours": BEHAVIOUR_SPEC.json_schema(),
        "commands": COMMAND.json_schema(),
    }


def world(console: Console) -> dict[str, Any]:
    """The zone at this moment."""
    zone = console.zone
    people, actors = zone.count()
    recorder = console.state.recorder
    return {
        "zone": ZONE,
        "scene": zone.scene.name,
        "bounds": list(zone.scene.bounds),
        "tick": zone.tick,
        "tick_s": zone.tick_s,
        "people": people,
        "actors": actors,
        "most_actors": zone.most_actors,
        "commands_waiting": zone.commands_waiting,
        "doors": zone.doors.states(),
        "places": {place.name: [*place.position, place.z_m] for place in zone.scene.places},
        "revision": console.changes.revision,
        "pace": told(console.pace),
        "recording": None if recorder is None else recorder.told(),
        "planning_interval_ticks": zone.planning_interval,
    }


def actors(console: Console) -> dict[str, Any]:
    """All actors at this moment."""
    return {
        "tick": console.zone.tick,
        "revision": console.changes.revision,
        "actors": [_actor(console, spec) for spec in console.zone.actors.values()],
    }


def actor(console: Console, name: str) -> dict[str, Any]:
    """One actor with its effective parameters, each with where it comes from, and what holds it.

    It may be asked between two ticks only.

    Raises
    ------
    RefusedError
        There is no such actor.
    """
    spec = console.zone.actors.get(name)
    if spec is None:
        raise RefusedError.of("unknown_actor", f"there is no actor {name}", actor=name)
    groups = console.state.groups.names(spec)
    sources = console.state.overrides.effective(spec.id, groups)
    found = _actor(console, spec)
    found["tick"] = console.zone.tick
    found["revision"] = console.changes.revision
    found["behaviour"] = spec.behaviour.model_dump(mode="json")
    found["parameters"] = {name: source._asdict() for name, source in sources.items()}
    if found["avatar"] is not None:
        why = console.zone.explain(found["avatar"])
        found["since_s"] = why.since_s
        found["goal"] = None if why.goal is None else list(why.goal)
        found["goal_moved"] = (
            None
            if why.moved is None
            else {
                "by_m": round(why.moved.distance_m, 3),
                "why": why.moved.reason.name.lower(),
                "text": str(why.moved),
                "place": [round(value, 3) for value in why.moved.place],
            }
        )
        held = why.blocker
        by = why.in_the_way
        found["outcome"] = None if why.outcome is None else why.outcome.name.lower()
        found["in_the_way"] = None if by is None else {"kind": by.kind, "id": by.id}
        found["blocker"] = (
            None if held is None else {"kind": held.kind, "id": held.id, "away_m": held.away_m}
        )
    return found


def people(console: Console) -> dict[str, Any]:
    """Everyone who is connected, at this moment."""
    state, found = console.zone.state, []
    for avatar in state.ids[state.of_kind(PERSON)].tolist():
        name = console.moderation.name_of(avatar)
        if name is not None:
            x, y = state.positions[state.slot(avatar)].tolist()
            x, y, z = round(x, 3), round(y, 3), round(float(state.heights[state.slot(avatar)]), 3)
            found.append(
                {
                    "id": avatar,
                    "name": name,
                    "position": [x, y, z],
                    "x": x,
                    "y": y,
                    "z": z,
                    "muted_s": round(console.moderation.muted_s(avatar), 1),
                    **console.moderation.details(avatar),
                }
            )
    return {"tick": console.zone.tick, "people": found}


def parameters(console: Console) -> dict[str, Any]:
    """All values that are set, by scope, and the usual ones."""
    values = console.state.overrides.values
    return {
        "revision": console.changes.revision,
        "defaults": ActorParameters().model_dump(),
        "scopes": {
            str(scope).replace("own ", "actor:").replace("group ", "group:"): dict(found)
            for scope, found in values.items()
        },
    }


def _actor(console: Console, spec: ActorSpec) -> dict[str, Any]:
    zone = console.zone
    avatar = zone.avatar_of(spec.id)
    found: dict[str, Any] = {
        "id": spec.id,
        "name": spec.name,
        "tags": list(spec.tags),
        "groups": dict(console.state.groups.of(spec.id)),
        "behaviour": spec.behaviour.kind,
        "held": spec.id in console.state.held,
        "avatar": avatar,
    }
    if avatar is not None and avatar in zone.state:
        slot, state = zone.state.slot(avatar), zone.state
        x, y = state.positions[slot].tolist()
        found["position"] = [round(x, 3), round(y, 3), round(float(state.heights[slot]), 3)]
        found["heading_rad"] = round(float(state.headings[slot]), 4)
        found["speed_mps"] = round(float(state.speeds[slot]), 3)
        found["reason"] = Reason(int(state.reasons[slot])).name.lower()
    return found
