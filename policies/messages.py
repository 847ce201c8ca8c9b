"""The messages between the evaluation and a policy from outside: one JSON object a line.

The evaluation asks, the policy answers each question once:

    {"ask": "load", "policy": "my_policy.py:MyPolicy", "options": {}}
                                          -> {"ready": true, "decides": ["velocity"]}
    {"ask": "reset", "task": {...}}                                    -> {"ready": true}
    {"ask": "velocity", "observation": {...}}                          -> {"velocity": [vx, vy]}
    {"ask": "goal", "observation": {...}}               -> {"goal": [x, y]}, or with z, or null
    {"ask": "explain"}                     -> {"path": [[x, y], ..], "circles": [[x, y, r], ..]}

Instead of each answer there may be {"error": "why"}. The fields of a task and of an observation
are those of `interface`, in metres and seconds.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any, Final

import numpy as np

from esplanade.policies.interface import Floats, Observation, Person, Task

DECISIONS: Final = ("velocity", "goal")
"""The decisions that policies make; one that does not say makes those of velocities."""
LONGEST_ANSWER: Final = 1 << 20
"""Bytes of a line. A longer answer is a fault."""


class MessageError(ValueError):
    """A line is not a message; the text says why."""


def line_of(message: Mapping[str, Any]) -> bytes:
    """A message as a line. Numbers stay the same, bit for bit."""
    return json.dumps(message, separators=(",", ":"), default=_plain).encode() + b"\n"


def message_of(line: bytes) -> dict[str, Any]:
    """The message of a line.

    Raises
    ------
    MessageError
        The line is no JSON object.
    """
    try:
        found = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise MessageError(f"is no line of JSON: {error}") from None
    if not isinstance(found, dict):
        raise MessageError("is no JSON object")
    return found


def told_observation(observation: Observation) -> dict[str, Any]:
    """An observation as plain data."""
    told = _told(observation)
    return told | {"people": [_told(person) for person in observation.people]}


def told_task(task: Task) -> dict[str, Any]:
    """A task as plain data."""
    return _told(task)


def observation_of(told: Mapping[str, Any]) -> Observation:
    """The observation of plain data."""
    people = [
        Person(
            each["id"],
            np.array(each["position"]),
            np.array(each["velocity"]),
            each["radius"],
            np.array(each["past"]).reshape(-1, 2),
        )
        for each in told["people"]
    ]
    places = {name: np.array(told[name]) for name in ("position", "velocity", "goal", "waypoint")}
    return Observation(time_s=told["time_s"], people=people, **places)


def task_of(told: Mapping[str, Any]) -> Task:
    """The task of plain data."""
    arrays = {name: np.array(told[name]) for name in ("start", "goal")}
    walls = np.array(told["walls"], dtype=np.float64).reshape(-1, 2, 2)
    return Task(**{**told, **arrays, "walls": walls, "bounds": tuple(told["bounds"])})


def numbers_of(value: object, name: str, width: int, rows: range) -> Floats:
    """A list of as many rows as `rows` allows, each of `width` finite numbers, float64 (n, width).

    Raises
    ------
    MessageError
        It is something else.
    """
    given = value if isinstance(value, Sequence) else [value]
    try:
        found = np.array(given, dtype=np.float64).reshape(-1, width)
    except (TypeError, ValueError):
        raise MessageError(f"{name} is not made of {width} numbers: {str(value)[:80]}") from None
    if len(found) not in rows or not np.isfinite(found).all():
        raise MessageError(f"{name} is not {width} finite numbers: {str(value)[:80]}")
    return found


def _told(value: Any) -> dict[str, Any]:
    return {field.name: getattr(value, field.name) for field in fields(value)}


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot be told")
