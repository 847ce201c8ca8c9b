"""The names of the guidelines' measures, for options, without numpy."""

from typing import Final

GUIDELINES: Final = {
    "spl": "success weighted by path length",
    "stl": "success weighted by time",
    "time_to_collision": "least time to a collision",
    "minimum_distance": "least distance to a person",
    "intimate": "time in somebody's intimate zone",
    "personal": "time in somebody's personal zone",
    "social": "time in somebody's social zone",
    "jerk": "mean jerk",
    "irregularity": "turning on the way",
    "force_work": "work of social forces",
    "groups": "groups walked through",
    "stalled": "time without moving",
    "delay": "delay imposed on people",
    "peak_acceleration": "acceleration imposed on people",
    "gave_way": "people who gave way",
}
