"""The metrics of live views."""

from collections.abc import Callable, Iterable

from esplanade.server.live.live import Live
from esplanade.server.metrics import Metrics


def watch_live(metrics: Metrics, views: Callable[[], Iterable[Live]]) -> None:
    """Add figures of the live views of all zones, which are there only while a world is."""

    def figure(read: Callable[[Live], float]) -> Callable[[], float]:
        def value() -> float:
            return sum(map(read, views()))

        return value

    metrics.gauge(
        "live_subscribers",
        "Consoles of operators with an open socket",
        figure(lambda live: len(live.subscribers)),
    )
    metrics.gauge(
        "live_messages_waiting",
        "Messages that wait for consoles which read slowly",
        figure(lambda live: sum(each.waiting for each in list(live.subscribers))),
    )
    metrics.total(
        "live_frames_dropped",
        "Frames of the map that were left out because a console was slow",
        figure(
            lambda live: (
                live.map_frames_dropped
                + sum(each.map_frames_dropped for each in list(live.subscribers))
            )
        ),
    )
    metrics.total(
        "live_too_slow",
        "Consoles that were closed because they did not read",
        figure(lambda live: live.too_slow),
    )
    metrics.gauge(
        "traces_waiting",
        "Requests for traces of decisions that wait for the end of a tick",
        figure(lambda live: live.tap.traces.waiting),
    )
    metrics.total(
        "traces",
        "Decisions of actors that were made once more for operators",
        figure(lambda live: live.tap.traces.made),
    )
    metrics.total(
        "traces_seconds",
        "Time of the actors' thread between ticks that traces of decisions took",
        figure(lambda live: live.tap.traces.seconds),
    )
    metrics.total(
        "traces_refused",
        "Requests for traces that were refused because too many waited",
        figure(lambda live: live.tap.traces.refused),
    )
    metrics.total(
        "live_ticks_lost",
        "Ticks that live views were not told of, since they were busy",
        figure(lambda live: live.tap.lost),
    )
    metrics.total(
        "live_notices_lost",
        "Notices of operators' changes that live views were not told of",
        figure(lambda live: live.bulletin.lost),
    )
