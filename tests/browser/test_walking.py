"""Bodies as a real page draws them: feet stay where they are planted."""

import math
import time
from collections.abc import AsyncIterator
from itertools import pairwise
from typing import Any, Final

import pytest
import pytest_asyncio
from playwright.async_api import BrowserContext, ViewportSize

from tests.browser.visitor import View, Visitor, own
from tests.browser.worlds import PROMENADE, PROMENADE_END, entered_at, world
from tests.patience import PATIENCE_S

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

FRAMES: Final = 80
SMALL: Final[ViewportSize] = {"width": 480, "height": 360}
FLAT_RAD: Final = 1e-3
"""A sole that is pitched less lies on the ground."""
PLANTED_M: Final = 1e-3
WALKED_M: Final = 2.0

# Everybody's feet in every frame, as they are drawn.
_RECORD: Final = """(count) => new Promise((resolve) => {
  const frames = [];
  const look = () => {
    frames.push(window.esplanade.avatars.map(
      ({ id, pose, feet, step }) => ({ id, pose, feet, step })
    ));
    if (frames.length < count) requestAnimationFrame(look);
    else resolve(frames);
  };
  requestAnimationFrame(look);
})"""

Frame = dict[int, dict[str, Any]]


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def promenade(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[str]:
    """Address of bare ground on which nothing stops a walk to the south."""
    scene = entered_at(PROMENADE, PROMENADE_END, tmp_path_factory.mktemp("promenade"))
    async with world(scene=scene) as address:
        yield address


async def test_planted_feet_do_not_move(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.page.set_viewport_size(SMALL)
    await ann.join("Ann")
    await ann.until(lambda view: any(_walks(avatar) for avatar in view["avatars"]))
    await ann.page.keyboard.down("s")
    frames: list[Frame] = []
    slides: list[tuple[float, int]] = []
    walked: dict[int, float] = {}
    deadline_s = time.monotonic() + PATIENCE_S
    # Where few frames are drawn, few of them show the same step twice.
    while max(walked.values(), default=0.0) <= WALKED_M:
        assert time.monotonic() < deadline_s, f"nobody takes steps: {walked}"
        frames += await _frames(ann)
        slides = _all_slides(frames)
        walked = {avatar_id: _distance_m(frames, avatar_id) for _, avatar_id in slides}
    await ann.page.keyboard.up("s")

    slide_m, avatar_id = max(slides)
    assert slide_m < PLANTED_M, f"avatar {avatar_id} slides {slide_m * 1e3:.2f} mm in a frame"
    assert await ann.complaints() == []


async def test_the_own_avatar_takes_steps(promenade: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, promenade)
    await ann.join("Ann")
    view = await ann.until(lambda view: _own_foot(view) is not None)
    first = _own_foot(view)
    await ann.page.keyboard.down("s")
    await ann.until(lambda view: _own_foot(view) not in (None, first))
    await ann.until(lambda view: _own_foot(view) == first)
    await ann.page.keyboard.up("s")
    assert await ann.complaints() == []


async def test_footprints_and_joints_are_shown_on_demand(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    await ann.page.click("#help-open")
    await ann.page.check("#skeletons")
    await ann.page.click("#help-close")
    before = (await ann.look())["frames"]
    await ann.until(lambda view: view["frames"] > before + 10)
    assert await ann.complaints() == []


async def _frames(visitor: Visitor) -> list[Frame]:
    recorded = await visitor.page.evaluate(_RECORD, FRAMES)
    return [{avatar["id"]: avatar for avatar in frame} for frame in recorded]


def _all_slides(frames: list[Frame]) -> list[tuple[float, int]]:
    """The movement of each planted foot from one frame to the next, and the id of its avatar."""
    return [
        (slide_m, avatar_id)
        for before, after in pairwise(frames)
        for avatar_id in before.keys() & after.keys()
        for slide_m in _slides_m(before[avatar_id], after[avatar_id])
    ]


def _slides_m(before: dict[str, Any], after: dict[str, Any]) -> list[float]:
    """The movement, in the midst of a step, of the heel or the toe on which a foot stands."""
    if before["step"] is None or before["step"] != after["step"]:
        return []
    side = before["step"]["stands"]
    was, now = before["feet"][side], after["feet"][side]
    pitches = was["pitch"], now["pitch"]
    if max(pitches) > FLAT_RAD and min(pitches) < -FLAT_RAD:
        return []  # It has rolled from the heel to the toe in between.
    point = "heel" if max(pitches) > FLAT_RAD else "toe"
    return [math.dist(_place(was[point]), _place(now[point]))]


def _distance_m(frames: list[Frame], avatar_id: int) -> float:
    """The distance that an avatar went while the frames were drawn."""
    places = [frame[avatar_id]["pose"] for frame in frames if avatar_id in frame]
    return math.dist(_place(places[0]), _place(places[-1]))


def _place(point: dict[str, float]) -> tuple[float, float, float]:
    return point["x"], point["y"], point["z"]


def _walks(avatar: dict[str, Any]) -> bool:
    return bool(avatar["pose"]["speed"] > 0.5)


def _own_foot(view: View) -> str | None:
    """The foot on which the own avatar stands; None while it has no steps."""
    avatar = own(view)
    step = avatar["step"] if avatar else None
    return None if step is None else str(step["stands"])
