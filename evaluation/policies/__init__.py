"""The policies by name. The module of a policy is imported only when the policy is made."""

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any, Final, NamedTuple, cast

from esplanade.evaluation.policies.policy import Policy
from esplanade.evaluation.policy_options import has_options
from esplanade.policies.errors import PolicyError
from esplanade.policies.names import is_outside


class Entry(NamedTuple):
    """The module of a policy, and its class or function there."""

    module: str
    maker: str


POLICIES: Final = {
    "esplanade": Entry("ours", "Esplanade"),
    "straight": Entry("straight", "Straight"),
    "discs": Entry("discs", "Discs"),
    "oracle": Entry("oracle", "Oracle"),
    "human": Entry("human", "Human"),
    "orca": Entry("orca", "Orca"),
    "jupedsim-speed": Entry("jupedsim_models", "speed"),
    "jupedsim-anticipation": Entry("jupedsim_models", "anticipation"),
    "jupedsim-forces": Entry("jupedsim_models", "forces"),
}
"""The policies; `esplanade.evaluation.options` has a summary of each."""


def make_policy(name: str, settings: Mapping[str, Any] | None = None) -> Policy:
    """Make the policy of a name in `POLICIES`, or one from outside.

    `settings` are those of our actor, or the options of a policy that has some; all others ignore
    them.

    Raises
    ------
    PolicyError
        The package that the policy needs is not installed, or an option cannot be.
    """
    if is_outside(name):
        outside = import_module("esplanade.evaluation.policies.outside")
        return cast(Policy, outside.Outside(name, settings))
    entry = POLICIES[name]
    maker = cast(
        Callable[..., Policy],
        getattr(import_module(f"esplanade.evaluation.policies.{entry.module}"), entry.maker),
    )
    return maker(settings) if name == "esplanade" or has_options(name) else maker()


__all__ = ["POLICIES", "Policy", "PolicyError", "make_policy"]
