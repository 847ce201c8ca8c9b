"""The recorder makes a block of each tick of a zone; it waits for nothing."""

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from esplanade.recordings.samples import Head
from esplanade.server.trajectories.blocks import Block
from esplanade.server.trajectories.provenance import Origin, provenance_of
from esplanade.server.trajectories.rates import ticks_between
from esplanade.server.trajectories.sampling import Sampler
from esplanade.server.trajectories.walkable import walkable_wkt
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Batch, Input, OneActorCommand, PlanEvery
from esplanade.server.world.state import ACTOR
from esplanade.server.world.zone import Zone

MOST_COMMANDS: Final = 4096
"""Commands whose outcome is not known yet; of more, the oldest is forgotten."""


class Recorder:
    """Gathers what files of trajectories are made of; call `take` after each tick."""

    def __init__(self, zone: Zone, hz: float | None = None) -> None:
        """`hz` is the number of samples a second; without it there is one for each tick.

        Raises
        ------
        ValueError
            Samples at this rate would lie between ticks.
        """
        self._zone = zone
        self._sampler = Sampler(zone, ticks_between(round(1.0 / zone.tick_s, 6), hz))
        self._commands: dict[int, OneActorCommand | Batch] = {}
        self._began = False
        self.named: Mapping[int, str] = {}
        """The names of recorded people in their recording, by their avatars' ids."""

    @property
    def last_frame(self) -> int:
        """The frame that was due last."""
        return self._zone.tick // self._sampler.every

    def head(self, origin: Origin) -> Head:
        """The head of a file."""
        scene, fps = self._zone.scene, self._sampler.fps
        told = provenance_of(origin, self._zone, fps)
        return Head(told, fps, scene.bounds, walkable_wkt(scene))

    def take(self, frame: Frame, inputs: Sequence[Input]) -> Block | None:
        """The block of the tick that has ended; None if there is nothing to write of it."""
        for item in inputs:
            if isinstance(item, OneActorCommand | Batch):
                self._commands[item.command] = item
        while len(self._commands) > MOST_COMMANDS:
            self._commands.pop(next(iter(self._commands)))
        done = [
            command
            for outcome in frame.outcomes
            if (command := self._commands.pop(outcome.command, None)) is not None
            and outcome.fault is None
        ]
        due = self._sampler.is_due(frame.tick)
        doors = frame.events.doors
        avatars = [each.id for each in frame.entered] + [each.id for each in frame.reshaped]
        parameters, interval = {}, None
        if any(isinstance(item, PlanEvery) for item in inputs):
            interval = self._zone.planning_interval
        if not self._began:
            self._began = True
            parameters = {actor: self._zone.parameters(str(actor)) for actor in self._zone.actors}
            avatars = np.sort(self._zone.state.ids[self._zone.state.live()]).tolist()
            interval = self._zone.planning_interval
        if not (due or done or doors or avatars or parameters or interval):
            return None
        return Block(
            frame.tick,
            self._sampler.frame(frame.tick),
            self._sampler.samples() if due else None,
            tuple(self._avatar(avatar) for avatar in avatars if avatar in self._zone.state),
            tuple(done),
            dict(doors),
            parameters,
            interval,
        )

    def _avatar(self, avatar_id: int) -> dict[str, Any]:
        """An avatar without the name of a person."""
        state = self._zone.state
        slot = state.slot(avatar_id)
        told: dict[str, Any] = {"id": avatar_id, "radius_m": round(float(state.radii[slot]), 4)}
        if int(state.kinds[slot]) == ACTOR:
            return {**told, "kind": "actor", "actor": self._zone.actor_of(avatar_id)}
        recorded = self.named.get(avatar_id)
        return {**told, "kind": "person", **({} if recorded is None else {"recorded": recorded})}
