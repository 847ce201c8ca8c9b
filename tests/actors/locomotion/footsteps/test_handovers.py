"""A step that a client receives goes on where the one before ended."""

import numpy as np
import pytest

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.planning import Polygon, Ramp, Scene, Stairs
from esplanade.protocol.steps import KEY_M, StepRecords
from tests.actors.locomotion.handovers import Handovers, handovers
from tests.actors.locomotion.parade import TICK_S, Parade

STAIRS = Stairs(start=(2.0, 0.0), end=(5.0, 0.0), width_m=4.0, top_m=1.75, steps=10)
TOP = Polygon(
    points=((5.0, -2.0), (8.0, -2.0), (8.0, 2.0), (5.0, 2.0)), height_m=1.75, kind="floor"
)
SLOPE = Polygon(
    points=((8.0, -2.0), (13.0, -2.0), (13.0, 2.0), (8.0, 2.0)),
    height_m=1.75,
    kind="floor",
    ramp=Ramp(start=(13.0, 0.0), end=(8.0, 0.0)),
)
HILL = Scene(name="hill", bounds=(-4.0, -6.0, 20.0, 6.0), polygons=(TOP, SLOPE), stairs=(STAIRS,))
PEOPLE = 16


def received(parade: Parade) -> Handovers:
    """The handovers of everyone, but for those who stand anew, of whom nothing is promised."""
    latest: dict[int, StepRecords] = {}
    pairs, of = [], []
    for begun in parade.begun:
        for row, slot in enumerate(begun.slots.tolist()):
            record = begun.records[row : row + 1]
            if slot in latest and record["ticks"][0] > 0:
                pairs.append((latest[slot], record))
                of.append(slot)
            latest[slot] = record
    slots = np.array(of)
    return handovers(pairs, BodySizes(parade.sizes.leg_m[slots], parade.sizes.stature_m[slots]))


def on_flat_ground() -> Parade:
    """Starts, sudden turns, stops, turns in place and slow steps aside."""
    parade = Parade(PEOPLE)
    parade.stand()
    before = (0.0, 0.0)
    for velocity in ((1.4, 0.0), (-1.4, 0.0), (0.0, 1.7), (0.0, 0.0), (1.0, 1.0), (1.0, -1.0)):
        for slot in range(PEOPLE):  # so that everyone is caught at another moment
            parade.go(np.where(np.arange(PEOPLE)[:, None] <= slot, velocity, before))
        parade.go(velocity, ticks=20)
        before = velocity
    parade.go((0.0, 0.0), ticks=30)
    parade.headings = parade.headings + np.linspace(-3.0, 3.0, PEOPLE)
    parade.go((0.0, 0.0), ticks=40)
    parade.go((0.0, 0.28), ticks=60, turn=False)
    parade.go((0.0, 0.0), ticks=40)
    return parade


def over_the_hill() -> Parade:
    """Up the stairs, over the top and down the slope; half of them turn round on the stairs."""
    parade = Parade(PEOPLE, HILL)
    ticks = np.arange(360)
    speed = np.linspace(0.6, 1.3, PEOPLE)[:, None]
    x = np.clip(speed * TICK_S * ticks, 0.0, 15.0)
    turns = np.arange(PEOPLE)[:, None] % 2 == 0
    x = np.where(turns & (x > 3.7), np.maximum(7.4 - x, 0.0), x)
    way = np.zeros((PEOPLE, len(ticks), 3))
    way[..., 0], way[..., 1] = x, np.linspace(-1.2, 1.2, PEOPLE)[:, None]
    up = 0.175 * np.clip(np.ceil((x - 2.0) / 0.3), 0.0, 10.0)
    way[..., 2] = np.where(x > 8.0, np.maximum(1.75 * (13.0 - x) / 5.0, 0.0), up)
    parade.positions = way[:, 0].copy()
    parade.stand()
    parade.follow(way)
    return parade


@pytest.mark.parametrize("walk", [on_flat_ground, over_the_hill])
def test_a_step_goes_on_where_the_one_before_ended_bit_for_bit(walk) -> None:
    found = received(walk())
    whole = ~found.re_aimed
    assert whole.sum() > 200
    assert not found.root[whole].any()
    assert not found.pelvis[whole].any()
    assert not found.pitches[whole].any()
    assert not found.upper_body[whole].any()
    assert not found.footprint.any()


@pytest.mark.parametrize("walk", [on_flat_ground, over_the_hill])
def test_nothing_is_drawn_to_jump_from_record_to_record(walk) -> None:
    found = received(walk())
    whole = ~found.re_aimed
    assert (~whole).any()
    assert found.drawn_root_m[whole].max() < 1e-9
    assert found.drawn_ankles_m[whole].max() < KEY_M
    assert found.drawn_headings_rad.max() < 0.6e-4
    assert found.drawn_root_m.max() < 3.0 * KEY_M
    assert found.drawn_ankles_m.max() < 3.0 * KEY_M
