"""Guides wave back at people who wave near them, and nobody else does."""

import pytest

from esplanade.protocol import Gesture
from esplanade.server.world.greetings import NEAR_M
from esplanade.server.world.inputs import Join, MakeGesture
from tests.server.populated import Populated, spec

TOUR = {"kind": "guide", "tour": ["west", "east"], "pause_s": 60.0}


def hall() -> tuple[Populated, int, int]:
    """A guide and somebody who wanders, and the avatars of both."""
    world = Populated([spec(1, "guide", behaviour=TOUR), spec(2, "idle")])
    world.frames(2)
    guide, idler = (world.zone.avatar_of(f"main/a{k}") for k in (1, 2))
    assert guide is not None
    assert idler is not None
    return world, guide, idler


def come_in(world: Populated, apart_m: float, guide: int) -> int:
    """Somebody who stands so far from the guide."""
    x, y, z = world.zone.where(guide)
    side = -1.0 if x > world.zone.scene.bounds[2] / 2.0 else 1.0
    frame = world.frame(Join(1, "Ann", (x + side * apart_m, y, z)))
    return frame.joined[0][1]


@pytest.mark.parametrize(
    ("gesture", "apart_m", "answers"),
    [
        (Gesture.WAVE, 2.0, True),
        (Gesture.WAVE, NEAR_M + 2.0, False),
        (Gesture.CLAP, 2.0, False),
    ],
    ids=["near", "far", "no wave"],
)
def test_a_guide_waves_back(gesture: Gesture, apart_m: float, answers: bool) -> None:
    world, guide, _ = hall()
    ann = come_in(world, apart_m, guide)
    made = world.frame(MakeGesture(ann, gesture)).events.gestures
    assert made == {ann: gesture, **({guide: Gesture.WAVE} if answers else {})}
    assert world.frame().events.gestures == {}
