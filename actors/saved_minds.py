"""The memory of behaviours and the chance of each actor, as bytes that are made once."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping
from typing import Any

import msgpack
import numpy as np

from esplanade.actors.behaviour import Behaviour


class SavedMinds:
    """Packs anew only those who were asked since the last time: that is cheap in every second."""

    def __init__(self) -> None:
        self._packed: dict[Hashable, bytes] = {}
        # Making a packer takes several times as long as packing what one actor has in mind.
        self._packer = msgpack.Packer(default=sorted)

    def change(self, ids: Iterable[Hashable]) -> None:
        """These actors have something else in mind, or are gone."""
        for actor_id in ids:
            self._packed.pop(actor_id, None)

    def change_all(self) -> None:
        """Anybody may have something else in mind."""
        self._packed.clear()

    def save(
        self,
        behaviours: Mapping[Hashable, Behaviour],
        generators: Mapping[Hashable, np.random.Generator],
    ) -> list[bytes]:
        """One for each actor, in their order; what custom behaviours hold must be plain data."""
        packed = self._packed
        for actor_id, behaviour in behaviours.items():
            if actor_id not in packed:
                chance = generators[actor_id].bit_generator.state
                packed[actor_id] = self._packer.pack([behaviour.save(), chance_as_text(chance)])
        return [packed[actor_id] for actor_id in behaviours]


def load_mind(packed: bytes, behaviour: Behaviour, generator: np.random.Generator) -> None:
    """Let a behaviour go on as the one did that was saved, with its chance.

    Raises
    ------
    ValueError, KeyError, TypeError
        These are no such bytes.
    """
    if not isinstance(packed, bytes):
        raise TypeError(f"what an actor has in mind is {type(packed).__name__}, not bytes")
    try:
        saved, chance = msgpack.unpackb(packed, strict_map_key=False)
    except msgpack.UnpackException as error:
        raise ValueError(f"what an actor has in mind cannot be unpacked: {error}") from error
    behaviour.load(saved)
    load_chance(generator, chance)


def chance_as_text(state: Mapping[str, Any]) -> list[str | int]:
    """The state of a generator; its numbers have more bits than plain data."""
    inner = state["state"]
    return [
        state["bit_generator"],
        str(inner["state"]),
        str(inner["inc"]),
        state["has_uint32"],
        state["uinteger"],
    ]


def load_chance(generator: np.random.Generator, saved: Any) -> None:
    """Let a generator go on as the one whose state that was.

    Raises
    ------
    ValueError
        It is no such state.
    """
    kind, state, inc, has_uint32, uinteger = saved
    generator.bit_generator.state = {
        "bit_generator": kind,
        "state": {"state": int(state) % 2**128, "inc": int(inc) % 2**128},
        "has_uint32": int(has_uint32) % 2,
        "uinteger": int(uinteger) % 2**32,
    }
