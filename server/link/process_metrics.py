"""The metrics of a process that takes part in a world on several machines."""

from collections.abc import Sequence

from nats.aio.client import Client

from esplanade.server.metrics import Metrics


def process_metrics(zones: Sequence[str], broker: Client) -> Metrics:
    """The metrics of a process in which none of these zones ticks yet."""
    metrics = Metrics(zones)
    for zone in zones:
        metrics.rests(zone)
    metrics.gauge("broker_connected", "Whether a broker is there", lambda: int(broker.is_connected))
    return metrics
