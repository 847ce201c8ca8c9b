"""The page in a world that is paused, stepped and slowed: everybody stands, or walks smoothly."""

import math
from collections.abc import AsyncIterator
from itertools import pairwise
from typing import Any, Final

import pytest
import pytest_asyncio
from playwright.async_api import BrowserContext, ViewportSize

from esplanade.server.app import Running
from tests.browser.visitor import Visitor
from tests.browser.worlds import PROMENADE, PROMENADE_END, built, entered_at, served
from tests.server.console.operators import Operator, operator

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

ROUNDS: Final = 8
"""A busy machine lets ticks and frames come late; of so many rounds it leaves one undisturbed."""

SMALL: Final[ViewportSize] = {"width": 480, "height": 360}
WALK_MPS: Final = 1.4
BACK_M: Final = 0.02
"""In a usual frame a body that walks on is drawn back by no more than this."""

USUAL_FRAME_S: Final = 1 / 30
"""In a frame that takes longer, more of a correction that fades is drawn."""

MOST_STILL: Final = 5
"""A page sends no more than this to a world that stands while nobody touches it."""

LAST_FRAMES: Final = 5
"""While nobody is drawn elsewhere in so many frames, everybody stands."""

MOST_LOOKS: Final = 120
"""A busy machine draws the ticks that it was told of within so many looks of half a second."""

TEN_TICKS_M: Final = 0.4
"""Ten ticks of walking bring an avatar further than this."""

# Where the own avatar and others are drawn in every frame, and when.
_RECORD: Final = """(seconds) => new Promise((resolve) => {
  const frames = [];
  const begun = performance.now();
  const look = (ms) => {
    const { avatars, correctionM } = window.esplanade;
    const places = avatars.map(({ id, own, pose }) => [id, own, pose.x, pose.y]);
    frames.push({ s: ms / 1000, places, correctionM });
    if (performance.now() - begun < 1000 * seconds) requestAnimationFrame(look);
    else resolve(frames);
  };
  requestAnimationFrame(look);
})"""


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def promenade(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Running]:
    """A server of bare ground with actors, on which nothing stops a walk to the south."""
    built("index.html")
    scene = entered_at(PROMENADE, PROMENADE_END, tmp_path_factory.mktemp("promenade"))
    async with served(scene=scene, actors=4) as server:
        yield server


async def test_the_picture_goes_at_the_pace_of_the_world(
    promenade: Running, profile: BrowserContext
) -> None:
    olga = await operator(promenade, "olga", "director")
    ann = await Visitor.arrive(profile, f"http://127.0.0.1:{promenade.port}/")
    await ann.page.set_viewport_size(SMALL)
    await ann.join("Ann")
    for left in reversed(range(ROUNDS)):
        await ann.page.keyboard.down("s")
        try:
            await _pause_step_and_slow(promenade, ann, olga)
        except AssertionError:
            if left == 0:
                raise
            await olga.send({"op": "pace", "pause": False, "factor": 1})
            await ann.page.keyboard.up("s")
        else:
            break
    await ann.page.wait_for_selector("#pace", state="hidden")
    await ann.page.keyboard.up("s")
    assert await ann.complaints() == []


async def _pause_step_and_slow(promenade: Running, ann: Visitor, olga: Operator) -> None:
    """Assert that Ann, who walks to the south, is drawn as the pace of the world has it."""
    await _frames(ann, 2.0)  # the first steps
    usual = await _frames(ann, 2.0)
    assert _own_mps(usual) > 0.7 * WALK_MPS
    assert _back_m(usual) < BACK_M

    paused = await _changed(ann, olga, 0.8, pause=True)
    assert _back_m(paused) < BACK_M
    assert await ann.page.is_visible("#pace")
    assert "paused" in (await ann.page.inner_text("#pace"))
    stood = await _frames(ann, 0.5)
    assert _most_moved_m(stood) == 0.0
    tick = promenade.world.tick
    stepped = await _changed(ann, olga, 1.5, step=10)
    for _ in range(MOST_LOOKS):
        if _walked_m(stood, stepped) > TEN_TICKS_M and _most_moved_m(stepped[-LAST_FRAMES:]) == 0.0:
            break
        stepped += await _frames(ann, 0.5)
    # Ticks in which nobody moves take in messages that Ann's page sends to a world that stands.
    assert tick + 10 <= promenade.world.tick <= tick + 10 + MOST_STILL
    assert _back_m(stepped) < BACK_M
    assert TEN_TICKS_M < _walked_m(stood, stepped) < 1.1
    assert _most_moved_m(await _frames(ann, 0.5)) == 0.0

    await olga.send({"op": "pace", "factor": 0.25})
    slow = await _changed(ann, olga, 3.0, pause=False)
    assert _back_m(slow) < BACK_M
    late = slow[len(slow) // 2 :]
    assert 0.15 * WALK_MPS < _own_mps(late) < 0.4 * WALK_MPS
    assert "0.25" in (await ann.page.inner_text("#pace"))

    again = await _changed(ann, olga, 2.0, factor=1)
    assert _back_m(again) < BACK_M
    assert _own_mps(again[len(again) // 2 :]) > 0.7 * WALK_MPS


async def _changed(
    ann: Visitor, olga: Operator, seconds: float, **pace: object
) -> list[dict[str, Any]]:
    """Everything that is drawn from just before another pace on."""
    recording = ann.page.evaluate(_RECORD, seconds)
    status, answer = await olga.send({"op": "pace", **pace})
    assert status == 200, answer
    return list(await recording)


async def _frames(ann: Visitor, seconds: float) -> list[dict[str, Any]]:
    return list(await ann.page.evaluate(_RECORD, seconds))


def _own(frame: dict[str, Any]) -> tuple[float, float]:
    return next((x, y) for _, own, x, y in frame["places"] if own)


def _walked_m(before: list[dict[str, Any]], after: list[dict[str, Any]]) -> float:
    """The distance from where the own avatar was last drawn to where it is last drawn now."""
    return math.dist(_own(before[-1]), _own(after[-1]))


def _own_mps(frames: list[dict[str, Any]]) -> float:
    return math.dist(_own(frames[0]), _own(frames[-1])) / (frames[-1]["s"] - frames[0]["s"])


def _back_m(frames: list[dict[str, Any]]) -> float:
    """The furthest that the own avatar, which walks to the south, is drawn back in a usual frame.

    What the page has to take back, since ticks came late on a busy machine, does not count.
    """
    return max(
        (_own(after)[1] - _own(before)[1] - before["correctionM"])
        / max(1.0, (after["s"] - before["s"]) / USUAL_FRAME_S)
        for before, after in pairwise(frames)
    )


def _most_moved_m(frames: list[dict[str, Any]]) -> float:
    """The furthest that anybody is drawn from where they were."""
    first = {who: (x, y) for who, _, x, y in frames[0]["places"]}
    return max(
        math.dist(first[who], (x, y))
        for frame in frames
        for who, _, x, y in frame["places"]
        if who in first
    )
