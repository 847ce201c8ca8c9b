"""The figures of a run, each with its unit and definition."""

from typing import Final, NamedTuple

ENCOUNTER_M: Final = 3.0
"""An actor and a person whose middles are nearer than this meet."""
NEAR_M: Final = 0.2
"""A person has an actor near whose body is within this of the own; as `esplanade evaluate`."""
CONFLICT_S: Final = 2.0
"""A person is in conflict with an actor that would be touched within this time."""
TOWARD_MPS: Final = 0.1
"""An actor moves toward whom it touches if it does so faster than this."""


class Measure(NamedTuple):
    """A figure: the name in files, a label with its unit, digits to print, and what it means."""

    name: str
    label: str
    digits: int
    meaning: str
    reacting: bool = False
    """Whether it is of people who react, and of nobody else."""


MEASURES: Final = (
    Measure(
        "encounters",
        "encounters",
        1,
        f"times that an actor and a person came within {ENCOUNTER_M:g} m of each other",
    ),
    Measure("contacts", "contacts", 2, "times that an actor and a person touched"),
    Measure(
        "toward",
        "contacts, actor moving toward them",
        2,
        f"contacts in which the actor went toward the person, faster than {TOWARD_MPS:g} m/s",
    ),
    Measure(
        "clearance_m",
        "smallest clearance, mean m",
        3,
        "the smallest distance between the two bodies, on average over encounters",
    ),
    Measure(
        "near_s",
        f"people with an actor within {NEAR_M:g} m, s",
        2,
        "seconds of people, added up over all of them",
    ),
    Measure(
        "conflict_s",
        f"people with a contact {CONFLICT_S:g} s ahead, s",
        2,
        "seconds of people whom an actor would touch within that time if both went on as they do "
        "(time to collision)",
    ),
    Measure(
        "displacement_m",
        "displacement of people, mean m",
        3,
        "the greatest distance of a person from the recorded place, on average over people",
        reacting=True,
    ),
    Measure(
        "delay_s",
        "delay of people, mean s",
        3,
        "the longest delay of a person behind the recording, on average over people",
        reacting=True,
    ),
    Measure("trips", "trips of actors that arrived", 1, "those that began in the stretch"),
    Measure("trip_s", "time of a trip, mean s", 2, "of these trips, from the wish to the goal"),
    Measure("speed_mps", "speed of actors on trips, m/s", 3, "metres walked by the time on trips"),
    Measure(
        "hindered_percent",
        "actors giving way or waiting, %",
        2,
        "the part of the time of all actors in which they gave way or waited",
    ),
)
"""All figures, in the order of tables; those of people come before those of actors."""


def shown(*, reacting: bool) -> tuple[Measure, ...]:
    """The figures that people of that kind have."""
    return tuple(each for each in MEASURES if reacting or not each.reacting)
