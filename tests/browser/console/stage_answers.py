"""Answers of the staged server."""

import base64
import math
from typing import Any, Final

import numpy as np

from esplanade.actors import ActorParameters
from esplanade.server.accounts.rights import ROLES

ACCOUNT: Final = "olga"
PASSWORD: Final = "correct horse battery"
NAMES: Final = ("Anna", "Ben", "Clara", "David", "Emma", "Felix", "Greta", "Hugo")


def answers(
    tick: int, actors: int, people: int, path: str, body: Any
) -> dict[str, Any] | list[Any] | None:
    """The answer to a question; None for what there is not."""
    if path.startswith("actors/"):
        return _of_actor(tick, *_split(path.removeprefix("actors/")))
    match path:
        case "me":
            rights = sorted(ROLES["admin"])
            return {"account": ACCOUNT, "role": "admin", "rights": rights, "via": "session"}
        case "world":
            return _world(tick, actors, people)
        case "zones":
            zone = {"name": "", "scene": "stage", "people": people, "actors": actors}
            return {"here": "", "zones": [zone]}
        case "map":
            return ground()
        case "heat":
            return _heat()
        case "series/names":
            return {"series": []}
        case "series":
            return {"step_s": 1, "at_us": [], "values": {}, "marks": []}
        case "events" | "changes":
            return {path: []}
        case "commands":
            return {"op": body["op"], "tick": tick, "revision": 1, "faults": []}
    return None


def ground() -> dict[str, Any]:
    """A plan with two storeys."""
    rooms = [[20.0 * i, 0.0, 20.0 * i, 36.0, z, z + 3.0] for i in (1, 2, 3) for z in (0.0, 4.0)]
    edges = [
        [*a, *b, z, z + 3.0]
        for z in (0.0, 4.0)
        for a, b in (
            ((0.0, 0.0), (80.0, 0.0)),
            ((80.0, 0.0), (80.0, 50.0)),
            ((80.0, 50.0), (0.0, 50.0)),
            ((0.0, 50.0), (0.0, 0.0)),
        )
    ]
    door = {"name": "café", "x0": 20.0, "y0": 36.0, "x1": 20.0, "y1": 38.0, "z_m": 0.0}
    solid = [[30.0, 10.0], [34.0, 10.0], [34.0, 14.0], [30.0, 14.0]]
    whole = [[0.0, 0.0], [80.0, 0.0], [80.0, 50.0], [0.0, 50.0]]
    return {
        "scene": "stage",
        "bounds": [0.0, 0.0, 80.0, 50.0],
        "origin_m": [0.0, 0.0],
        "storeys": [{"z_m": 0.0, "name": "ground"}, {"z_m": 4.0, "name": "+4.0 m"}],
        "walls": rooms + edges,
        "doors": [{**door, "open": True}],
        "places": [
            {"name": "fountain", "x": 40.0, "y": 42.0, "z": 0.0},
            {"name": "library", "x": 10.0, "y": 20.0, "z": 4.0},
        ],
        "spawns": [],
        "stairs": [],
        "outlines": [[solid], []],
        "kinds": [["furniture"], []],
        "floors": [[whole], [whole]],
    }


def entered(actors: int, people: int) -> list[dict[str, Any]]:
    """Everybody, as the map tells."""
    found: list[dict[str, Any]] = [
        {
            "id": index + 1,
            "kind": "actor",
            "name": f"Actor {index + 1}",
            "actor": f"main/actor-{index + 1}",
            "radius_m": 0.25,
            "groups": ["wanderers" if index % 2 else "guides"],
            "behaviour": "wander",
        }
        for index in range(actors)
    ]
    found += [
        {
            "id": actors + index + 1,
            "kind": "person",
            "name": f"{NAMES[index % len(NAMES)]} {index + 1}",
            "radius_m": 0.25,
        }
        for index in range(people)
    ]
    return found


def layers(tick: int, actors: int) -> dict[str, Any]:
    """Planned ways, goals and circles of all actors."""
    ids = [f"main/actor-{index + 1}" for index in range(actors)]
    starts = {who: (8.0 + 7 * i % 64, 8.0 + 11 * i % 34) for i, who in enumerate(ids)}
    return {
        "channel": "map.layers",
        "tick": tick,
        "ways": {who: [[x + s, y + s, 0.0] for s in range(6)] for who, (x, y) in starts.items()},
        "goals": {who: [x + 6, y + 6, 0.0] for who, (x, y) in starts.items()},
        "circles": {
            who: [[x + s, y, 0.0, 0.3 + 0.2 * s, float(s)] for s in range(4)]
            for who, (x, y) in starts.items()
        },
    }


def contacts(tick: int) -> dict[str, Any]:
    """One contact."""
    x = 8.0 + tick % 60
    pair = [x, 20.0, 0.0, "main/actor-1", 21, "person"]
    return {"channel": "contacts", "tick": tick, "pairs": [pair]}


def actor_message(tick: int, channel: str) -> dict[str, Any]:
    """The answer of the live interface about one actor."""
    path = [[10.0 + s, 10.0 + math.sin(s), 0.0, 0.5 * s] for s in range(12)]
    parts = {"time": 6.1, "risk": 1.4, "turn": 0.3, "wall": 0.2, "hurry": 0.0, "keep_right": 0.1}
    parts["others"] = 0.2
    return {
        "channel": channel,
        "tick": tick,
        "x": 10.0,
        "y": 10.0,
        "z": 0.0,
        "heading": 0.3,
        "speed": 1.1,
        "reason": "waiting" if tick // 100 % 2 else "moving",
        "blocker": {"kind": "person", "id": 21, "name": "Anna 1", "away_m": 0.9}
        if tick // 100 % 2
        else None,
        "behaviour": {"kind": "wander", "rest_s": 4.0, "next": "fountain"},
        "goal": [21.0, 9.0, 0.0],
        "path": path,
        "cost": {**parts, "total": round(sum(parts.values()), 2)},
        "previous": {
            "path": [[x, y + 2.0, z, t] for x, y, z, t in path],
            "cost": {**parts, "risk": 3.4, "total": 10.1},
        },
    }


def _split(path: str) -> tuple[str, str]:
    for tail in ("why", "trace"):
        if path.endswith(f"/{tail}"):
            return path.removesuffix(f"/{tail}"), tail
    return path, ""


def _of_actor(tick: int, actor: str, tail: str) -> dict[str, Any] | None:
    if tail == "why":
        return {"spans": _spans(tick)}
    if tail == "trace":
        return _trace(tick)
    defaults = ActorParameters().model_dump()
    sources = {
        name: {"value": value, "level": "default", "group": None}
        for name, value in defaults.items()
    }
    sources["risk_weight"] = {"value": 12.0, "level": "world", "group": None}
    return {
        "id": actor,
        "name": actor.removeprefix("main/").replace("-", " ").capitalize(),
        "tags": ["wanderers"],
        "behaviour": {"kind": "wander", "rest_s": [2.0, 8.0]},
        "held": False,
        "avatar": int(actor.rpartition("-")[2]),
        "position": [10.0, 10.0, 0.0],
        "speed_mps": 1.1,
        "reason": "moving",
        "tick": tick,
        "revision": 1,
        "parameters": sources,
        "since_s": 3.0,
        "goal": [21.0, 9.0, 0.0],
        "blocker": None,
    }


def _spans(tick: int) -> list[dict[str, Any]]:
    kinds = ("moving", "giving_way", "moving", "waiting", "replanning", "moving", "no_path")
    found, at = [], tick - 12000
    for index in range(40):
        reason = kinds[index % len(kinds)]
        ticks = 60 + index * 97 % 500
        held = reason in ("waiting", "giving_way")
        blocker = {"kind": "person", "id": 21, "name": "Anna 1", "away_m": 0.7} if held else None
        span = {"from_tick": at, "to_tick": min(tick, at + ticks), "reason": reason}
        found.append({**span, "blocker": blocker, "seconds": round(ticks * 0.05, 2)})
        at += ticks
        if at >= tick:
            break
    return found


def _trace(tick: int) -> dict[str, Any]:
    nodes = [[10.0, 10.0, 0.0, 0.0, -1, 0.0, 0]]
    for index in range(1, 300):
        parent = (index - 1) // 2
        x, y, _, t, *_ = nodes[parent]
        turn = 0.9 * math.sin(index * 1.7)
        node = [x + 0.6 * math.cos(turn), y + 0.6 * math.sin(turn), 0.0, t + 0.5, parent]
        nodes.append([*node, index * 0.1, index if index < 120 else -1])
    message = actor_message(tick, "")
    return {
        "actor": "main/actor-1",
        "tick": tick,
        "exact": True,
        "status": "found",
        "expansions": 120,
        "budget": 400,
        "nodes": nodes,
        "left_out": 0,
        "previous": None,
        "searched": None,
        "perturbed": None,
        "blocker": None,
        "path": message["path"],
        "cost": message["cost"],
        "risk": [
            {"t_s": round(0.4 * i, 1), **_raster(40, 40, (4.0, 4.0), 0.3, phase=0.4 * i)}
            for i in range(10)
        ],
        "why": {
            "code": "search",
            "text": "the search found a better path",
            "arguments": {},
        },
    }


def _world(tick: int, actors: int, people: int) -> dict[str, Any]:
    plan = ground()
    return {
        "zone": "main",
        "scene": "stage",
        "bounds": plan["bounds"],
        "tick": tick,
        "tick_s": 0.05,
        "people": people,
        "actors": actors,
        "most_actors": 1000,
        "commands_waiting": 0,
        "doors": {"café": True},
        "places": {place["name"]: [place["x"], place["y"], place["z"]] for place in plan["places"]},
        "revision": 1,
        "pace": {"factor": 1.0, "paused": False},
        "recording": {
            "state": "on",
            "file": "stage.mcap",
            "bytes": 1_250_000,
            "seconds": 754,
            "fault": None,
        },
        "planning_interval_ticks": 1,
    }


def _heat() -> dict[str, Any]:
    return {
        "storeys": [{"z_m": z, **_raster(160, 100, (0.0, 0.0), 0.5, phase=z)} for z in (0.0, 4.0)]
    }


def _raster(
    width: int, height: int, origin: tuple[float, float], cell_m: float, phase: float
) -> dict[str, Any]:
    x, y = np.meshgrid(np.linspace(0, 6, width), np.linspace(0, 4, height))
    values = np.clip(np.sin(x + phase) * np.sin(y), 0.0, None).astype("<f4")
    return {
        "width": width,
        "height": height,
        "cell_m": cell_m,
        "origin_m": list(origin),
        "values": base64.b64encode(values.tobytes()).decode(),
    }
