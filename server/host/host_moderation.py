"""Moderates the people of a hosted zone, whose connections are at gateways."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from esplanade.server.host.guests import Guests, SeatsOfZone
from esplanade.server.link.line_numbers import LINES, line_number
from esplanade.server.moderation.state import ModerationState
from esplanade.server.net.known_people import KnownPerson
from esplanade.server.net.lines import Lines
from esplanade.server.net.moderation import PeopleModeration
from esplanade.server.world.audience import Heard
from esplanade.server.world.frame import Frame, Line
from esplanade.server.world.zone import Zone


class HostModeration(PeopleModeration):
    """Moderates people by their seats. Lines get their numbers here.

    Bans are those of the whole cluster: gateways send out whom they are of, wherever that is.
    """

    def __init__(
        self,
        state: ModerationState,
        world: Zone,
        storeys: Sequence[float],
        guests: Guests,
        seats: SeatsOfZone,
        kick: Callable[[int], None],
        now_s: Callable[[], float],
        place: int,
    ) -> None:
        """`kick` gives up the seat of a person; `place` is that of the zone among all."""
        super().__init__(state, world, storeys, guests, seats, kick, now_s)
        self.lines = Lines(line_number(place, world.tick + 1, 0), self._said)
        self._place = place
        self._guests = guests

    def known(self, person: int) -> KnownPerson | None:
        """A person whose seat is here, or who has left within the last minutes."""
        guest = self._guests.known(person)
        return super().known(person) if guest is None else self._of(guest)

    def numbered(self, frame: Frame) -> Frame:
        """The same frame, with numbers for its lines of chat."""
        if not frame.events.chat:
            return frame
        chat = [
            replace(line, number=line_number(self._place, frame.tick, k))
            for k, line in enumerate(frame.events.chat[:LINES])
        ]
        for line in chat:
            self.lines.take(Heard(line, self._name_in(line), []))
        return replace(frame, events=replace(frame.events, chat=chat))

    def _name_in(self, line: Line) -> str:
        return self.reportable(line.id) or ""
