"""The measured constants of the scale model, each with the command that gives it."""

import json
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import get_type_hints


@dataclass(frozen=True)
class Constants:
    """Costs of the parts of a world on several machines. Those that are given here were measured
    on two cores of about 3 GHz; `--constants` takes those of another machine."""

    tick_hz: float = 20.0
    """Ticks a second."""
    host_tick_us: float = 4200.0
    """Processor time of a host beside its zone and messages, in the time of a tick: renewals,
    checkpoints, seats, threads (`benchmarks.cluster crowd`, 100 and 300 people)."""
    zone_tick_us: float = 150.0
    """Processor time of a zone's tick with nobody in it (`benchmarks.server --processor-time`)."""
    zone_person_us: float = 1.7
    """The same for each person who is there: 70 % of them walk (`benchmarks.frames`)."""
    frame_make_us: float = 14e-3
    """To make a frame bytes, for each avatar in it (`benchmarks.frames`)."""
    frame_read_us: float = 21e-3
    """To read it again, in each gateway that has it (`benchmarks.frames`)."""
    frame_head_bytes: float = 120.0
    """Bytes of a frame that tells nothing, with subject and head."""
    frame_avatar_bytes: float = 24.5
    """Bytes of a frame for each avatar (`benchmarks.frames`)."""
    gateway_tick_us: float = 1400.0
    """Of a gateway that people are at, beside them, in the time of a tick; 830 with nobody at it
    (`benchmarks.cluster crowd`, and `check`, where a gateway shows three zones)."""
    gateway_zone_us: float = 1300.0
    """The same for each zone that it shows, beside messages and viewers."""
    broker_message_us: float = 100.0
    """Of the broker for each message that it takes or passes on (`benchmarks.cluster check`)."""
    message_us: float = 60.0
    """To send or take in one message of the broker, on either side (`benchmarks.frames`)."""
    viewer_us: float = 13.5
    """Of a gateway for each viewer and tick, reading and writing its socket included
    (`benchmarks.live sides`, less what the zone takes)."""
    viewer_bytes_s: float = 12_000.0
    """Most bytes a viewer is sent a second: its budget, which a crowd uses up."""
    lone_viewer_bytes_s: float = 700.0
    """Bytes of a viewer who sees nobody else."""
    seen_avatar_bytes_s: float = 217.0
    """Bytes more for each avatar in view, up to the budget (`benchmarks.cluster check`)."""
    seen_part: float = 0.34
    """Part of the others in a zone whom one has in view: of those who stand anywhere on a field of
    100 m, the part within 40 m."""
    most_seen: float = 100.0
    """Most avatars in view."""
    input_bytes: float = 40.0
    """Bytes of a movement in a batch of a gateway."""
    inputs_s: float = 0.5
    """Changes of mind of a person in a second."""
    lease_s: float = 3.0
    """After this time without renewal a zone may have another owner."""
    renew_s: float = 1.0
    """Time from one renewal to the next, and from one checkpoint to the next."""
    take_over_s: float = 0.6
    """From the end of a lease until a host that stands by ticks (`make chaos-cluster`)."""
    checkpoint_person_bytes: float = 71.0
    """Bytes of a checkpoint for each person."""
    hop_commits: float = 2.0
    """Transactions of a hop: the seat's, and that it was taken in."""
    come_back_s: float = 1.0
    """Time that a client waits before it comes back to another gateway."""
    joins_s: float = 200.0
    """People whom a gateway welcomes in a second."""

    @classmethod
    def of(cls, path: Path) -> "Constants":
        """The same with the values of a JSON file in their places.

        Raises
        ------
        ValueError
            A name is unknown, or a value is no number above zero.
        """
        given = json.loads(path.read_text())
        known = get_type_hints(cls)
        for name, value in given.items():
            if name not in known:
                names = ", ".join(each.name for each in fields(cls))
                raise ValueError(f"{path}: there is no constant {name!r}; there are: {names}")
            if not isinstance(value, int | float) or not value > 0:
                raise ValueError(f"{path}: {name}: {value!r} is no number above zero")
        return cls(**{**asdict(cls()), **given})
