"""The server's metrics, in one registry of their own.

A count that grows thousands of times a second is a plain integer in `Traffic`, read when scraped.
"""

from collections.abc import Callable, Iterable, Mapping
from copy import copy
from dataclasses import dataclass
from functools import partial
from time import monotonic
from typing import Final

import numpy as np
from prometheus_client import CollectorRegistry, Counter, Histogram, generate_latest
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector

_NAMESPACE: Final = "esplanade"
_TICK_BUCKETS_S: Final = (0.002, 0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.075, 0.1, 0.25, 1.0)
_KEPT_TICKS: Final = 24_000
_WINDOW_TICKS: Final = 1_200


class Durations:
    """The latest durations, at most 24 000 (20 minutes of 20 ticks a second)."""

    def __init__(self) -> None:
        self._ring = np.zeros(_KEPT_TICKS, dtype=np.float32)
        self._count = 0

    def add(self, seconds: float) -> None:
        self._ring[self._count % _KEPT_TICKS] = seconds
        self._count += 1

    def percentile(self, percent: float, latest: int = _KEPT_TICKS) -> float:
        """A percentile of the `latest` durations, seconds; 0 if there are none."""
        count = min(self._count, latest, _KEPT_TICKS)
        if not count:
            return 0.0
        places = (self._count - 1 - np.arange(count)) % _KEPT_TICKS
        return float(np.percentile(self._ring[places], percent))


@dataclass
class Traffic:
    """Totals of the messages on people's connections."""

    messages_in: int = 0
    bytes_in: int = 0
    messages_out: int = 0
    bytes_out: int = 0
    steps_out: int = 0
    step_bytes_out: int = 0
    snapshots_skipped: int = 0
    movements_superseded: int = 0


_TRAFFIC_HELP: Final = {
    "messages_in": "Messages from clients",
    "bytes_in": "Bytes of messages from clients",
    "messages_out": "Messages to clients",
    "bytes_out": "Bytes of frames to clients",
    "steps_out": "Steps of walkers sent to clients",
    "step_bytes_out": "Bytes of these steps, without the heads of frames",
    "snapshots_skipped": "Snapshots left out, and the steps with them, because a client was slow",
    "movements_superseded": "Movements that a later one replaced before a tick took them",
}


class _Figure(Collector):
    """A figure that is kept elsewhere: `read` by the world's thread, collected by any.

    In a world of several zones it has a value for each of them, by the zone's name.
    """

    def __init__(
        self, family: type[CounterMetricFamily] | type[GaugeMetricFamily], name: str, text: str
    ) -> None:
        self._family = family
        self._name = f"{_NAMESPACE}_{name}"
        self._text = text
        self._reads: dict[str | None, Callable[[], float]] = {}
        self._values: dict[str | None, float] = {}

    def add(self, zone: str | None, read: Callable[[], float]) -> None:
        """Have a value for a zone; None for the whole process.

        Raises
        ------
        ValueError
            It has one already, or one that has no zone.
        """
        if self._reads.keys() & {zone, None}:
            raise ValueError(f"the figure {self._name} is there already")
        self._reads[zone], self._values[zone] = read, 0.0

    def reading(self, zone: str) -> Callable[[], float] | None:
        """The function that reads the value of a zone; None if there is none."""
        return self._reads.get(zone)

    def forget(self, zone: str) -> None:
        """Have no value for a zone any more; another one takes its place."""
        self._reads.pop(zone, None)
        self._values.pop(zone, None)

    def sample(self) -> None:
        for zone, read in self._reads.items():
            self._values[zone] = read()

    def collect(self) -> Iterable[Metric]:
        values = dict(self._values)
        if None in values:
            family = self._family(self._name, self._text)
            family.add_metric([], values[None])
        else:
            family = self._family(self._name, self._text, labels=["zone"])
            for zone, value in values.items():
                family.add_metric([str(zone)], value)
        yield family


class _Age(Collector):
    """The seconds since something, at the moment when it is collected."""

    def __init__(self, name: str, text: str, since: Callable[[], float]) -> None:
        self._name = f"{_NAMESPACE}_{name}"
        self._text = text
        self._since = since

    def collect(self) -> Iterable[Metric]:
        yield GaugeMetricFamily(self._name, self._text, max(0.0, monotonic() - self._since()))


class Metrics:
    """The server's metrics; names begin with `esplanade_`.

    Figures that are kept elsewhere are read by `sample`, in the thread that changes them; all else
    is safe in any thread. In a world of several zones each has a view of its own (`of_zone`), and
    what is told of ticks and zones has the label `zone`.
    """

    def __init__(self, zones: Iterable[str] = ()) -> None:
        """`zones` are the names of the zones of a world that has several."""
        self.registry = CollectorRegistry()
        self._zone: str | None = None
        self._figures: dict[str, _Figure] = {}
        self._ticked: dict[str | None, float] = dict.fromkeys(zones, monotonic()) or {
            None: monotonic()
        }
        self.sampled_at = monotonic()
        """When the figures were last read, seconds of `monotonic`."""
        for name, text, since in (
            ("tick_age_seconds", "Time since the last tick ended", lambda: self.ticked_at),
            ("sample_age_seconds", "Time since the world gave figures", lambda: self.sampled_at),
        ):
            self.registry.register(_Age(name, text, since))
        label = [] if None in self._ticked else ["zone"]
        self.traffic = Traffic()
        self.ticks = Durations()
        for name, text in _TRAFFIC_HELP.items():
            self.total(name, text, partial(getattr, self.traffic, name))
        self._tick_seconds = Histogram(
            "tick_duration_seconds",
            "Time from the begin of a tick until its last frame is written",
            label,
            namespace=_NAMESPACE,
            buckets=_TICK_BUCKETS_S,
            registry=self.registry,
        )
        self._stage_seconds = self._counter(
            "tick_stage_seconds", "Time spent in each stage of the tick", [*label, "stage"]
        )
        self.errors = self._counter("errors", "Errors told to clients, by code", ["code"])
        self.closes = self._counter("closes", "Connections ended by the server", ["reason"])
        self.dropped_slow = self._counter(
            "clients_dropped_slow", "Clients dropped because they did not read", ["limit"]
        )
        self.sockets_refused = self._counter(
            "sockets_refused", "Connections that were not let in, or cut off for others", ["why"]
        )
        self.answers_refused = self._counter(
            "answers_refused", "Requests that were told to come later, or broken off", ["why"]
        )
        self.floods = self._counter(
            "floods", "Connections closed because of what they sent, before it was parsed", ["what"]
        )
        self.joins = self._counter("joins", "People who came in", ["way"])
        self.operator_keys_refused = self._counter(
            "operator_keys_refused", "Operator keys that were wrong or not read", ["why"]
        )
        self.seats_yielded = self._counter(
            "seats_yielded", "Vacant seats given up for newcomers to a full world"
        )
        self.lines_refused = self._counter(
            "lines_refused", "Lines of chat that nobody heard, by the reason", ["why"]
        )
        self.chat_lines = self._counter("chat_lines", "Lines of chat that people have said")
        self.planning_failures = self._counter(
            "planning_failures", "Ticks in which the actors' planning failed and they stood still"
        )
        self.hops = self._counter("hops", "People who stepped into portals", ["result"])
        if not label:
            self._tell_ticks()

    def readings(self, zone: str) -> dict[str, Callable[[], float]]:
        """The functions that read figures of a zone, by the figures' names, for `read_again`."""
        found = ((name, figure.reading(zone)) for name, figure in self._figures.items())
        return {name: read for name, read in found if read is not None}

    def read_again(self, zone: str, readings: Mapping[str, Callable[[], float]]) -> None:
        """Read of a zone what was read of it before, and nothing else."""
        for name, figure in self._figures.items():
            figure.forget(zone)
            if name in readings:
                figure.add(zone, readings[name])

    def of_zone(self, zone: str) -> "Metrics":
        """The same metrics as one zone of several gives them, from now on."""
        for figure in self._figures.values():
            figure.forget(zone)
        view = copy(self)
        view._show_zone(zone)  # noqa: SLF001 - of this class
        return view

    def _show_zone(self, zone: str) -> None:
        self._zone, self.ticks = zone, Durations()
        self._tick_seconds = self._tick_seconds.labels(zone)
        self._tell_ticks()

    def _tell_ticks(self) -> None:
        for percent in (50, 99):
            self.gauge(
                f"tick_p{percent}_seconds",
                f"Percentile {percent} of the last {_WINDOW_TICKS} ticks' durations",
                partial(self.ticks.percentile, percent, _WINDOW_TICKS),
            )

    @property
    def ticked_at(self) -> float:
        """When a tick last ended, seconds of `monotonic`; of several zones, of the latest one."""
        return min(self._ticked.values(), default=monotonic())

    def rests(self, zone: str) -> None:
        """The zone does not tick in this process now, and its age is told no more."""
        self._ticked.pop(zone, None)

    def gauge(self, name: str, text: str, read: Callable[[], float]) -> None:
        """Add a value that is read when scraped."""
        self._add(GaugeMetricFamily, name, text, read)

    def total(self, name: str, text: str, read: Callable[[], float]) -> None:
        """Add a total that is kept elsewhere and never falls."""
        self._add(CounterMetricFamily, name, text, read)

    def tick_took(self, seconds: float, stages: dict[str, float]) -> None:
        self._ticked[self._zone] = monotonic()
        self.ticks.add(seconds)
        self._tick_seconds.observe(seconds)
        zone = () if self._zone is None else (self._zone,)
        for stage, stage_seconds in stages.items():
            self._stage_seconds.labels(*zone, stage).inc(stage_seconds)

    def stood(self) -> None:
        """No tick was due, since the world is paused."""
        self._ticked[self._zone] = monotonic()

    def sample(self) -> None:
        """Read all figures that are kept elsewhere, in the thread that changes them."""
        for figure in list(self._figures.values()):
            figure.sample()
        self.sampled_at = monotonic()

    def render(self) -> bytes:
        """All metrics in Prometheus' text format, with the figures last sampled."""
        return generate_latest(self.registry)

    def exposition(self) -> bytes:
        """All metrics as they are now, in the thread that changes them."""
        self.sample()
        return self.render()

    def _add(
        self,
        family: type[CounterMetricFamily] | type[GaugeMetricFamily],
        name: str,
        text: str,
        read: Callable[[], float],
    ) -> None:
        figure = self._figures.get(name)
        if figure is not None:
            figure.add(self._zone, read)
            return
        figure = self._figures[name] = _Figure(family, name, text)
        figure.add(self._zone, read)
        self.registry.register(figure)

    def _counter(self, name: str, text: str, labels: Iterable[str] = ()) -> Counter:
        return Counter(name, text, labels, namespace=_NAMESPACE, registry=self.registry)
