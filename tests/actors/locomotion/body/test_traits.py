import numpy as np

from esplanade.actors.locomotion.body.traits import LONGEST_LEG_M, SHORTEST_LEG_M, traits_of


def test_everyone_is_different_and_always_the_same() -> None:
    everyone = [traits_of(3, avatar) for avatar in range(300)]
    assert everyone == [traits_of(3, avatar) for avatar in range(300)]
    assert len({one.leg_m for one in everyone}) > 250
    assert traits_of(4, 17) != everyone[17]


def test_sizes_are_those_of_people() -> None:
    everyone = [traits_of(0, avatar) for avatar in range(1000)]
    legs = np.array([one.leg_m for one in everyone])
    statures = np.array([one.stature_m for one in everyone])
    cadence_factor = np.array([one.cadence_factor for one in everyone])
    assert SHORTEST_LEG_M <= legs.min() < 0.8
    assert 0.95 < legs.max() <= LONGEST_LEG_M
    assert 1.35 < statures.min() < statures.max() < 1.95
    assert 0.02 < cadence_factor.std() < 0.08
