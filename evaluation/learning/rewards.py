"""The rewards of a trip, tick by tick."""

from dataclasses import dataclass

from esplanade.evaluation.learning.robots import Outcome, Robot
from esplanade.evaluation.rules import Rules


@dataclass(frozen=True)
class Rewards:
    """The weights of what a learner is rewarded for. The sum of a good trip is about its length."""

    advance: float = 1.0
    """For each metre toward the waypoint."""
    second: float = -0.3
    """For each second."""
    near: float = -2.0
    """For each second with somebody nearer than `Rules.near_m`."""
    reached: float = 5.0
    touched: float = -10.0
    """For a contact, with people, robots or walls."""

    def of(self, robot: Robot, rules: Rules) -> float:
        """The reward of a robot's last tick."""
        near = self.near if robot.gap_m < rules.near_m else 0.0
        ends = {
            Outcome.REACHED: self.reached,
            Outcome.TOUCHED: self.touched,
            Outcome.WALL: self.touched,
        }
        ended = 0.0 if robot.outcome is None else ends.get(robot.outcome, 0.0)
        return self.advance * robot.advance_m + rules.tick_s * (self.second + near) + ended
