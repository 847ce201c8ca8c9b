"""The steps of a tick, all walkers in one call, against whole arrays at a time."""

from collections.abc import Callable

import numpy as np
import pytest

from esplanade.actors.locomotion.motion.key_poses import Steps
from tests.actors.locomotion.footsteps.test_handovers import HILL
from tests.actors.locomotion.footsteps.test_walkers import keyboard
from tests.actors.locomotion.parade import FIELD, TICK_S, Parade


def on_keys(parade: Parade) -> None:
    parade.stand()
    for velocities in keyboard(parade.count, seed=8)[:250]:
        parade.go(velocities)


def at_a_run(parade: Parade) -> None:
    parade.stand()
    for velocities in 1.9 * keyboard(parade.count, seed=4)[:150]:
        parade.go(velocities)
    assert any(begun.steps.flight.any() for begun in parade.begun)


def to_and_fro_on_the_hill(parade: Parade) -> None:
    """Over stairs and slope, with sudden turns, and off the sides of both."""
    random = np.random.default_rng(2)
    parade.positions[:, 0] = random.uniform(0.0, 15.0, parade.count)
    parade.positions[:, 1] = random.uniform(-1.8, 1.8, parade.count)
    parade.positions[:, 2] = 0.8
    angle = random.uniform(0.0, 2.0 * np.pi, parade.count)
    for tick in range(250):
        turns = random.random(parade.count) < 0.03
        angle = np.where(turns, random.uniform(0.0, 2.0 * np.pi, parade.count), angle)
        speed = np.where(np.arange(parade.count) % 5 == tick // 50, 0.0, 1.2)
        velocities = speed[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        x, y = (parade.positions[:, :2] + velocities * TICK_S).T
        on = np.abs(y) < 2.0
        up = 0.175 * np.clip(np.ceil((x - 2.0) / 0.3), 0.0, 10.0)
        slope = np.clip(1.75 * (13.0 - x) / 5.0, 0.0, 1.75)
        parade.positions[:, 2] = np.where(on, np.minimum(up, slope), 0.0)
        if tick == 0:
            parade.stand()
        parade.go(velocities)
    assert parade.walkers.lost > 0


def steps_of(parade: Parade) -> dict[tuple[int, int], Steps]:
    """The last step of each tick and slot."""
    return {
        (begun.tick, slot): begun.steps.take(np.array([row]))
        for begun in parade.begun
        for row, slot in enumerate(begun.slots.tolist())
    }


@pytest.mark.parametrize(
    ("walk", "scene"), [(on_keys, FIELD), (at_a_run, FIELD), (to_and_fro_on_the_hill, HILL)]
)
def test_steps_are_those_of_the_plain_twin(walk: Callable[[Parade], None], scene) -> None:
    parades = [Parade(24, scene, seed=3, naive=naive) for naive in (False, True)]
    for parade in parades:
        walk(parade)
    found, expected = (steps_of(parade) for parade in parades)
    assert len(found) > 400
    assert any(steps.re_aimed.any() for steps in found.values())
    assert found.keys() == expected.keys()
    assert parades[0].walkers.lost == parades[1].walkers.lost
    for key, steps in found.items():
        for one, other in zip(steps, expected[key], strict=True):
            np.testing.assert_allclose(one, other, atol=1e-9)
