"""A fork: a recorded stretch that is run again from its first tick, with something changed."""

from collections.abc import Iterator
from typing import Final

import numpy as np
import structlog

from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.whatif.changes import Changes
from esplanade.server.whatif.errors import WhatIfError
from esplanade.server.whatif.fork_inputs import (
    FIRST_COMMAND,
    ForkInputs,
    begun_anew,
    first_inputs,
    is_still,
)
from esplanade.server.whatif.stretch import Stretch
from esplanade.server.whatif.walkers import Walkers
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import ActorCommand, Input, PeoplePlaced
from esplanade.server.world.zone import Zone

OWN_IDS: Final = (2**31, 2**32)
"""Actors that come in have ids from here, so that recorded people keep theirs."""

log = structlog.get_logger(__name__)


class Fork:
    """One run of a stretch in a zone of its recording. The same run is the same, bit for bit."""

    def __init__(
        self,
        replayed: ReplayedZone,
        stretch: Stretch,
        changes: Changes,
        walkers: Walkers,
        seed: int | None = None,
    ) -> None:
        """Be at the first tick of the stretch; heavy.

        With another scene the zone is one of that scene, in which nothing has happened yet.
        With a `seed`, all that actors' behaviours draw is drawn anew from there.

        Raises
        ------
        WhatIfError
            The changes would be refused by the world.
        """
        zone = replayed.zone
        if changes.scene is None:
            replayed.go_to(stretch.state)
        else:
            zone.skip_to(stretch.first_tick)
        zone.state.begin_ids(*OWN_IDS)
        if seed is not None:
            mixed = np.random.SeedSequence([stretch.head.built.seed, seed])
            replayed.population.draw_anew(int(mixed.generate_state(1)[0]))
        self.replayed = replayed
        self.walkers = walkers
        self.planning_failed = 0
        """Ticks in which nothing could be planned, and the actors stood."""
        self.is_still = False
        """Whether nobody moved in the latest tick: the world was paused."""
        self._stretch = stretch
        anew = [] if changes.scene is None else begun_anew(zone, stretch, changes)
        self._first = [*anew, *first_inputs(zone, changes)]
        self._inputs = ForkInputs(zone, stretch, changes, stretch.ticks)
        check(zone, self._first)

    @property
    def zone(self) -> Zone:
        """The zone, whose state is read between two ticks."""
        return self.replayed.zone

    def ticks(self) -> Iterator[Frame]:
        """Run the stretch, tick by tick.

        Raises
        ------
        WhatIfError
            A change was refused after all, such as of actors for whom there is no room.
        """
        for recorded in self._stretch.ticks:
            given = [*self._first, *self._inputs.of(recorded)]
            self.is_still = is_still(given)
            if not self.is_still:
                given.append(self._people(recorded.tick))
            frame = self._step(given)
            self._first = []
            for outcome in frame.outcomes:
                if outcome.fault is not None and outcome.command >= FIRST_COMMAND:
                    raise WhatIfError(outcome.fault.text)
            yield frame

    def _people(self, tick: int) -> PeoplePlaced:
        ids, places = self.walkers.at(tick, self.zone)
        return PeoplePlaced(ids, places)

    def _step(self, given: list[Input]) -> Frame:
        zone = self.zone
        self.replayed.inputs = given
        zone.begin(given)
        try:
            moved = zone.think()
        except Exception:
            # As in a server, the actors stand where they were.
            log.exception("planning failed", tick=zone.tick)
            self.planning_failed += 1
            moved = False
        return zone.finish(moved)


def check(zone: Zone, inputs: list[Input]) -> None:
    """Find out whether a zone would take commands.

    Raises
    ------
    WhatIfError
        It would not.
    """
    for item in inputs:
        if isinstance(item, ActorCommand):
            fault = zone.check(item)
            if fault is not None:
                raise WhatIfError(fault.text)
