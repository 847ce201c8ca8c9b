"""An independent implementation of the same rules, used if it lies beside the recordings."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.policies.policy import Observation, Person, Policy, Prescient, Task
from esplanade.evaluation.replay import Floats, Replay
from esplanade.evaluation.rules import Rules


def load_judge(recording: Path) -> ModuleType:
    """The module `tools/crowd_eval.py` of the folder that holds `data/`.

    The test is skipped if the file is absent.
    """
    path = recording.parents[2] / "tools" / "crowd_eval.py"
    if not path.is_file():
        pytest.skip("the independent judge crowd_eval.py is absent")
    spec = importlib.util.spec_from_file_location("crowd_eval", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["crowd_eval"] = module  # its dataclasses look up their module there
    spec.loader.exec_module(module)
    return module


class Judged:
    """One of our policies with the interface that the judge calls."""

    def __init__(self, policy: Policy, replay: Replay, rules: Rules, episode: Episode) -> None:
        self._policy = policy
        self._replay, self._episode = replay, episode
        self._task = Task(
            rules, replay.name, replay.obstacles, replay.bounds, episode.start, episode.goal
        )

    def reset(self, info: object) -> None:
        if isinstance(self._policy, Prescient):
            self._policy.foresee(self._replay, self._episode)
        self._policy.reset(self._task)

    def __call__(
        self, t: float, pos: Floats, vel: Floats, goal: Floats, others: list[object]
    ) -> Floats:
        people = [Person(o.id, np.array(o.pos_hist)) for o in others]  # type: ignore[attr-defined]
        return self._policy.decide(Observation(t, pos, vel, goal, people))
