"""Targets that an arm reaches for in two stages, for the web client's tests to read.

Write them anew with `python -m tests.browser.reach_vectors`.
"""

import json
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.actors.locomotion.reaching.two_stage import arm_chain, effector, reach

FIXTURE: Final = Path(__file__).parents[2] / "client_web" / "tests" / "fixtures" / "reach.json"

CASES: Final = 12
SWEEPS: Final = 60
_DIGITS: Final = 9


def vectors() -> dict[str, Any]:
    """Everything that the fixture holds, as plain JSON values."""
    return {"sweeps": SWEEPS, "left": _arm(left=True), "right": _arm(left=False)}


def text() -> str:
    """The fixture as it is stored."""
    return json.dumps(vectors(), indent=1) + "\n"


def _arm(*, left: bool) -> dict[str, Any]:
    """A chain and what becomes of it; without new starts, which a warm start does not need."""
    chain = arm_chain(left=left)
    random = np.random.default_rng(5)
    poses = random.uniform(chain.lows, chain.highs, (CASES, len(chain.lows)))
    targets = effector(chain, poses)
    start = np.clip(np.zeros(len(chain.lows)), chain.lows, chain.highs)
    reached = reach(chain, targets, start, random, sweeps=SWEEPS, restarts=0)
    return {
        "axes": chain.axes.tolist(),
        "offsets": chain.offsets.tolist(),
        "lows": chain.lows.tolist(),
        "highs": chain.highs.tolist(),
        "start": start.tolist(),
        "targets": targets.round(_DIGITS).tolist(),
        "angles": reached.angles.round(_DIGITS).tolist(),
        "left_over": reached.left.round(_DIGITS).tolist(),
    }


if __name__ == "__main__":
    FIXTURE.write_text(text(), encoding="utf-8")
