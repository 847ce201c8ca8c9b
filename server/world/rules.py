"""The rules that hold for every person of a zone."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Rules:
    """Sizes, speeds and sight. The server decides by them; clients are told."""

    person_radius_m: float
    person_clearance_m: float
    """Distance that a person's centre keeps from walls."""
    person_max_speed_mps: float
    person_walk_speed_mps: float
    view_radius_m: float
    view_limit: int
    steps_radius_m: float
    """Steps are sent of walkers that are within this distance, and in view."""
    steps_limit: int
    viewer_bytes: int
    """Bytes a second of snapshots and steps that one viewer is sent."""
    tick_rate: int
    """Ticks a second."""
