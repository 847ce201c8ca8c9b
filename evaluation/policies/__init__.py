"""Policies by name. A module is imported only when its policy is asked for."""

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any, Final, NamedTuple, cast

from esplanade.evaluation.policies.policy import Policy, PolicyError


class Entry(NamedTuple):
    """Where a policy is made, and what it is."""

    module: str
    maker: str
    summary: str


POLICIES: Final = {
    "esplanade": Entry("ours", "Esplanade", "the project's own actor"),
    "straight": Entry("straight", "Straight", "straight on, whoever is in the way"),
    "discs": Entry("discs", "Discs", "constant velocities, hard discs, space-time A*"),
    "clairvoyant": Entry("clairvoyant", "Clairvoyant", "the same, shown the true future"),
    "human": Entry("human", "Human", "the recorded pedestrian's own way"),
    "jupedsim-speed": Entry("jupedsim_models", "speed", "JuPedSim, collision-free speed"),
    "jupedsim-anticipation": Entry(
        "jupedsim_models", "anticipation", "JuPedSim, anticipation velocity"
    ),
    "jupedsim-forces": Entry("jupedsim_models", "forces", "JuPedSim, social forces"),
}


def make_policy(name: str, settings: Mapping[str, Any] | None = None) -> Policy:
    """A policy by its name; `settings` of our actor are for "esplanade" alone.

    Raises
    ------
    PolicyError
        Its package is not installed.
    """
    entry = POLICIES[name]
    maker = cast(
        Callable[..., Policy],
        getattr(import_module(f"esplanade.evaluation.policies.{entry.module}"), entry.maker),
    )
    return maker(settings) if name == "esplanade" else maker()


__all__ = ["POLICIES", "Policy", "PolicyError", "make_policy"]
