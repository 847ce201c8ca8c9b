"""A zone that a recording is run again in, tick by tick."""

import time
from collections.abc import Hashable, Mapping
from types import TracebackType
from typing import Any, Self

from esplanade.actors import Population
from esplanade.planning import LayeredGrid
from esplanade.server.populating import populate_from
from esplanade.server.recording.errors import ZoneRecordingError
from esplanade.server.recording.head import Head
from esplanade.server.recording.reader import RecordedTick
from esplanade.server.roster import Roster
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Input
from esplanade.server.world.recorded_inputs import input_of
from esplanade.server.world.zone import ROOM_FOR_ACTORS, Zone


class ReplayedZone:
    """The zone of a recording, at the tick of the state that it was given last."""

    def __init__(self, head: Head) -> None:
        """Build the zone; kernels are compiled where they are not yet."""
        built = head.built
        grid = LayeredGrid.from_scene(head.scene)
        self.population: Population = populate_from(
            Roster(),
            grid,
            head.scene,
            built.tick_s,
            built.seed,
            person_radius_m=built.person_radius_m,
        )
        # Only their number counts: who is there, and by what name, comes with the state.
        names: dict[Hashable, str] = dict.fromkeys(range(built.most_actors - ROOM_FOR_ACTORS), "")
        self.zone = Zone(
            head.scene,
            grid,
            self.population,
            names,
            built.rules,
            tick_s=built.tick_s,
            max_people=built.max_people,
            seed=built.seed,
            clock=time.perf_counter,
        )
        self.population.warm_up()
        self.inputs: list[Input] = []
        """Those of the latest tick."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.population.close()

    def go_to(self, state: Mapping[str, Any]) -> None:
        """Be where the recorded zone was at that state; heavy.

        Raises
        ------
        ZoneRecordingError
            The state is none of this zone.
        """
        try:
            self.zone.load_exactly(state)
        except (ValueError, KeyError, TypeError) as error:
            raise ZoneRecordingError(
                f"the state cannot be read: {type(error).__name__}: {error}"
            ) from error

    def step(self, recorded: RecordedTick) -> Frame:
        """Run the next tick with its inputs.

        Raises
        ------
        ZoneRecordingError
            An input is none; the message names tick and input.
        """
        zone = self.zone
        self.inputs = []
        for number, plain in enumerate(recorded.inputs, start=1):
            try:
                self.inputs.append(input_of(plain, zone))
            except (ValueError, KeyError, TypeError) as error:
                raise ZoneRecordingError(
                    f"tick {recorded.tick}: input {number} of {len(recorded.inputs)} cannot be "
                    f"read: {error}"
                ) from error
        zone.begin(self.inputs)
        return zone.finish(zone.think())
