"""Measures the environments for learners: steps of one core a second among about twenty people.

    python -m benchmarks.learning
    python -m benchmarks.learning --steps 1000000

The recording is a made one: people cross a plaza from four sides, so that about twenty are there at
every moment. Actions are random; the time of resets is in it. An agent-step is the step of one
robot: of `CrowdEnv` each robot's counts.
"""

import argparse
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from esplanade.evaluation.learning.crowds import CrowdEnv
from esplanade.evaluation.learning.trips import TripEnv

SIDE_M = 15.0
PEOPLE = 20
SPEED_MPS = 1.2
LASTS_S = 300.0
SAMPLE_S = 0.4


def made_recording(folder: Path) -> Path:
    """The file of a plaza on which about `PEOPLE` people walk at any time."""
    random = np.random.default_rng(5)
    crosses_s = SIDE_M / SPEED_MPS
    rows = ["t,id,x,y"]
    for person, due in enumerate(np.arange(0.0, LASTS_S, crosses_s / PEOPLE)):
        begins = round(due / SAMPLE_S) * SAMPLE_S
        a, b = random.uniform(0.0, SIDE_M, 2)
        ends = [np.array([0.0, a]), np.array([SIDE_M, b])]
        if person % 2:
            ends.reverse()
        if person % 4 > 1:
            ends = [end[::-1] for end in ends]
        for passed in np.arange(0.0, crosses_s, SAMPLE_S):
            x, y = ends[0] + (ends[1] - ends[0]) * passed / crosses_s
            rows.append(f"{begins + passed:.1f},{person},{x:.3f},{y:.3f}")
    path = folder / "plaza.csv"
    path.write_text("\n".join(rows) + "\n")
    return path


def steps_of_one(env: TripEnv, steps: int) -> int:
    """Walk by random actions; returns the agent-steps."""
    env.reset(seed=0)
    for _ in range(steps):
        *_, terminated, truncated, _ = env.step(env.action_space.sample())
        if terminated or truncated:
            env.reset()
    return steps


def steps_of_many(env: CrowdEnv, steps: int) -> int:
    """The same for several robots; at least `steps` agent-steps."""
    done = 0
    env.reset(seed=0)
    while done < steps:
        done += len(env.agents)
        env.step({agent: env.action_space(agent).sample() for agent in env.agents})
        if not env.agents:
            env.reset()
    return done


def main(words: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=20_000)
    options = parser.parse_args(words)
    print(f"{'environment':<14}{'people':<12}{'agent-steps a second':>22}")
    with tempfile.TemporaryDirectory() as folder:
        path = made_recording(Path(folder))
        for people in ("recorded", "reacting"):
            envs: list[tuple[str, Any, Any]] = [
                ("one robot", TripEnv(path, people), steps_of_one),
                ("five robots", CrowdEnv(path, 5, people), steps_of_many),
            ]
            for name, env, walk in envs:
                walk(env, 100)
                began_s = time.process_time()
                steps = walk(env, options.steps)
                rate = steps / (time.process_time() - began_s)
                print(f"{name:<14}{people:<12}{rate:>22.0f}")


if __name__ == "__main__":
    main()
