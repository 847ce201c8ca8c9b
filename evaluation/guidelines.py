"""The measures of the guidelines for social navigation, each with its definition and source."""

from collections.abc import Callable
from typing import Final, NamedTuple

from esplanade.evaluation.conduct import COLLISION_CAP_S, GROUP_M, GROUP_S, STALLED_MPS
from esplanade.evaluation.guideline_names import GUIDELINES
from esplanade.evaluation.people import GAVE_WAY_M
from esplanade.evaluation.scores import Score


class Guideline(NamedTuple):
    """One measure; its figure is the mean over episodes that have one."""

    name: str
    unit: str
    digits: int
    definition: str
    source: str
    of: Callable[[Score], float]
    """Gives the figure of an episode; nan if the episode has none."""

    @property
    def label(self) -> str:
        """The heading in tables."""
        title = GUIDELINES[self.name]
        return f"{title}, {self.unit}" if self.unit else title


def _spl(score: Score) -> float:
    return 1.0 / max(1.0, score.path_ratio) if score.reached else 0.0


def _stl(score: Score) -> float:
    return 1.0 / max(1.0, score.time_ratio) if score.reached else 0.0


_FRANCIS: Final = "Francis et al. 2023"
_HALL: Final = "Hall 1966"

MEASURES: Final = {
    found.name: found
    for found in (
        Guideline(
            "spl",
            "",
            3,
            "1 / max(1, walked / straight way) for trips that reach the goal, 0 for others",
            "Anderson et al. 2018",
            _spl,
        ),
        Guideline(
            "stl",
            "",
            3,
            "1 / max(1, time / time of the straight way at the preferred speed) for trips that "
            "reach the goal, 0 for others",
            "Xiao et al. 2022",
            _stl,
        ),
        Guideline(
            "time_to_collision",
            "s",
            2,
            "the least time, over ticks and people, until robot and person would touch if both "
            f"kept their velocities; at most {COLLISION_CAP_S:g}",
            _FRANCIS,
            lambda s: s.time_to_collision_s,
        ),
        Guideline(
            "minimum_distance",
            "m",
            2,
            "the least distance between the surfaces of robot and people, at most 2",
            _FRANCIS,
            lambda s: s.clearance_m,
        ),
        Guideline(
            "intimate",
            "s",
            2,
            "time in which the nearest person's surface is within 0.45 m",
            _HALL,
            lambda s: s.intimate_s,
        ),
        Guideline(
            "personal",
            "s",
            2,
            "time in which the nearest person's surface is 0.45 to 1.2 m away",
            _HALL,
            lambda s: s.personal_s,
        ),
        Guideline(
            "social",
            "s",
            2,
            "time in which the nearest person's surface is 1.2 to 3.6 m away",
            _HALL,
            lambda s: s.social_s,
        ),
        Guideline(
            "jerk",
            "m/s³",
            2,
            "the mean over ticks of the size of the change of acceleration",
            _FRANCIS,
            lambda s: s.jerk_mean_mps3,
        ),
        Guideline(
            "irregularity",
            "rad/m",
            3,
            "the sum of all turns, for each metre walked; a straight way has none",
            "Guzzi et al. 2013",
            lambda s: s.turning_radpm,
        ),
        Guideline(
            "force_work",
            "m/s",
            2,
            "the sum over ticks of the social force on the robot and those of the robot on people, "
            "times the tick; forces of Moussaïd et al. 2009",
            "Pérez-Higueras et al. 2023",
            lambda s: s.force_work_mps,
        ),
        Guideline(
            "groups",
            "",
            2,
            "pairs of people between whom the robot was, who had been within "
            f"{GROUP_M:g} m of each other for {GROUP_S:g} s",
            _FRANCIS,
            lambda s: s.groups_entered,
        ),
        Guideline(
            "stalled",
            "s",
            2,
            f"time in which the robot is slower than {STALLED_MPS:g} m/s",
            _FRANCIS,
            lambda s: s.stalled_s,
        ),
        Guideline(
            "delay",
            "s",
            2,
            "the sum over people of how late each is at most against the recorded timing; of "
            "reacting people, as the next two",
            "ours",
            lambda s: s.imposed_delay_s,
        ),
        Guideline(
            "peak_acceleration",
            "m/s²",
            2,
            "the greatest acceleration of anybody beyond the recorded one",
            "ours",
            lambda s: s.imposed_peak_mps2,
        ),
        Guideline(
            "gave_way",
            "",
            2,
            f"people who are displaced by more than {GAVE_WAY_M:g} m",
            "ours",
            lambda s: s.gave_way,
        ),
    )
}
"""All of them, by name."""
