"""The inbox of moderators: what people report, and what has been settled."""

from collections import OrderedDict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final, Literal

from esplanade.server.checkpoint.ids import Numbers
from esplanade.server.moderation.areas import Place

MOST_OPEN: Final = 500
"""Reports that may wait for moderators; more are refused."""
MOST_KEPT: Final = 2000
"""Of more reports the oldest that are settled are forgotten."""
MOST_OF_ONE: Final = 20
"""Reports by people of one address that may wait for moderators."""

State = Literal["open", "done"]


@dataclass(frozen=True, slots=True)
class Report:
    """A report of somebody, by somebody."""

    id: int
    at_us: int
    reporter: int
    """The avatar of the person who reports."""
    reporter_name: str
    person: int
    """The avatar that it is about."""
    name: str
    text: str
    place: Place | None
    """The place of that avatar then, if it was still there."""
    line: int | None = None
    said: str | None = None
    """The line of chat that is meant, where chat is kept."""
    state: State = "open"
    settled_by: str | None = None


class InboxFullError(Exception):
    """The inbox of reports is full."""


class Inbox:
    """Reports by their ids, in the order in which they came."""

    def __init__(self) -> None:
        self._reports: OrderedDict[int, Report] = OrderedDict()
        self._addresses: dict[int, str] = {}
        """The address from which each open report came; it is not kept."""
        self._open = 0
        self.numbers = Numbers()
        """Numbers of reports to come, which no other process gives."""

    def __iter__(self) -> Iterator[Report]:
        return iter(self._reports.values())

    @property
    def open(self) -> int:
        """Number of reports that wait for moderators."""
        return self._open

    def get(self, report: int) -> Report | None:
        return self._reports.get(report)

    def load(self, reports: list[Report]) -> None:
        """Begin with the reports that were kept, the oldest first."""
        for report in reports:
            self._reports[report.id] = report
        self._open = sum(report.state == "open" for report in reports)

    def take_in(self, new: Iterable[Report], states: Mapping[int, tuple[str, str | None]]) -> None:
        """Take in reports that other processes have got, and the states that are kept of all."""
        for report in new:
            if report.id not in self._reports:
                self._reports[report.id] = report
                self._open += report.state == "open"
        for report_id, (state, by) in states.items():
            self.settle(report_id, "done" if state == "done" else "open", by)

    def check_room(self, address: str) -> None:
        """See that there is room for a report from an address.

        Raises
        ------
        InboxFullError
            Too many wait already.
        """
        if self._open >= MOST_OPEN:
            raise InboxFullError(f"{MOST_OPEN} reports wait for moderators already")
        of_address = sum(one == address for one in self._addresses.values())
        if of_address >= MOST_OF_ONE:
            raise InboxFullError(f"{MOST_OF_ONE} reports of yours wait for moderators already")

    def add(self, report: Report, address: str) -> list[int]:
        """Take a new report; returns the ids of those that are forgotten for it."""
        self._reports[report.id] = report
        self._addresses[report.id] = address
        self._open += 1
        gone: list[int] = []
        while len(self._reports) > MOST_KEPT:
            oldest = next(one.id for one in self._reports.values() if one.state == "done")
            del self._reports[oldest]
            gone.append(oldest)
        return gone

    def settle(self, report: int, state: State, by: str | None) -> None:
        """Note that a report has been settled, or is open again."""
        found = self._reports.get(report)
        if found is None or found.state == state:
            return
        self._reports[report] = replace(found, state=state, settled_by=by)
        self._open += 1 if state == "open" else -1
        self._addresses.pop(report, None)

    def drop(self, report: int) -> None:
        """Forget a report."""
        found = self._reports.pop(report, None)
        self._addresses.pop(report, None)
        if found is not None and found.state == "open":
            self._open -= 1
