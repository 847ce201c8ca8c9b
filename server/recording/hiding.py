"""Names and lines of people are left out of recordings; nothing that is computed needs them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from esplanade.server.live.names import stand_in
from esplanade.server.recording.seconds import Tick
from esplanade.server.world.exact_state import NAMES
from esplanade.server.world.inputs import Input, Join, Say
from esplanade.server.world.state import PERSON


def inputs_of(tick: Tick, *, names: bool, chat: bool) -> Sequence[Input]:
    """The inputs of a tick, with stand-ins for names and without chat unless asked for."""
    given: list[Input] = [each for each in tick.inputs if chat or not isinstance(each, Say)]
    if names:
        return given
    known = dict(tick.frame.joined)
    return [
        replace(each, name=stand_in(known.get(each.ticket, 0))) if isinstance(each, Join) else each
        for each in given
    ]


def state_of(state: Mapping[str, Any], *, names: bool) -> dict[str, Any]:
    """An exact state, with stand-ins for the names of people, unless these are asked for."""
    if names:
        return dict(state)
    avatars = state["avatars"]
    people = set(np.asarray(avatars["ids"])[np.asarray(avatars["kinds"]) == PERSON].tolist())
    hidden = {
        avatar: stand_in(avatar) if avatar in people else name
        for avatar, name in state[NAMES].items()
    }
    return {**state, NAMES: hidden}
