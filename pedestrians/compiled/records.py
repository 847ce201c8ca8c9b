"""The arrays that the kernels of reacting people take."""

from typing import NamedTuple

from esplanade.planning.compiled.arrays import Bools, Floats, Ints


class Numbers(NamedTuple):
    """A `SocialForce` as plain numbers, and the length of a tick."""

    tick_s: float
    relaxation_s: float
    return_s: float
    hurry: float
    usual_speed_mps: float
    velocity_share_s: float
    reach_m: float
    slowing_per_m: float
    turning_per_m: float
    side_bias_per_m: float
    sight_cosine: float
    unseen: float
    range_m: float
    wall_strength_mps2: float
    wall_reach_m: float
    wall_range_m: float
    wall_margin_m: float


class Paths(NamedTuple):
    """The recorded places of N people, tick by tick."""

    places: Floats
    """(T, 2) metres: one person's after the other's."""
    begins: Ints
    """(N + 1,): where each person's places begin, and the end of all."""
    first: Ints
    """(N,): the tick of each person's first place."""


class State(NamedTuple):
    """N people at a tick. Rows of people who are not there mean nothing."""

    places: Floats
    """(N, 2) metres."""
    deviations: Floats
    """(N, 2) m/s: velocity beyond the recorded one."""
    own_ticks: Floats
    """(N,): how far people are on their recorded paths, in ticks from their first."""
    moved: Bools
    """(N,): whether people are anywhere but at their recorded places."""


class Surroundings(NamedTuple):
    """Actors and walls that people react to, and everyone's strength of reaction."""

    actors: Floats
    """(A, 5): x and y in metres, their velocity in m/s, radius beyond a person's in metres."""
    stand_ins: Ints
    """(A,): the person whom an actor stands in for; -1 for nobody."""
    walls: Floats
    """(M, 4): x and y of both ends, metres."""
    passes: Bools
    """(N, M): whether the recording itself leads a person through a wall."""
    strengths_mps2: Floats
    """(N,): each person's A, scaled."""
