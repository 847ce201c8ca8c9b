"""The settings of policies that drive actors, without numpy."""

import json
from collections.abc import Mapping
from typing import Any, Final

from esplanade.commandline.readers import Text, Whole
from esplanade.commandline.settings import Setting
from esplanade.policies.names import address_of, is_outside

MOST_DRIVEN: Final = 16
"""Each has a process, or a connection, of its own."""
USUAL_COUNT: Final = 1
"""Actors that a policy drives beside those of a roster, if nothing is said."""
DRIVEN_TAG: Final = "policy"
"""The group of the actors that a policy drives."""

DRIVING: Final = {
    "policy": Setting(
        "drive actors by a policy of your own, FILE.py:CLASS, MODULE:CLASS, an entry point or "
        "tcp://HOST:PORT/NAME (docs/policies.md)",
        Text(),
    ),
    "policy_actors": Setting(
        "actors beside the others that it drives; it drives those of a roster with the tag "
        f"{DRIVEN_TAG} too; without it, {USUAL_COUNT}",
        Whole(0, MOST_DRIVEN),
    ),
    "policy_options": Setting("keywords for it, a JSON object", Text()),
}


def check(given: Mapping[str, Any]) -> None:
    """Check the settings of a policy.

    Raises
    ------
    ValueError
        They do not fit together; the message says which.
    """
    policy = given.get("policy")
    for name in ("policy_actors", "policy_options"):
        if given.get(name) is not None and policy is None:
            raise ValueError(f"{name}: it belongs to --policy, but none is given")
    if policy is None:
        return
    if given.get("world"):
        raise ValueError("policy: it drives actors of one scene, not of a world of several zones")
    if not is_outside(policy):
        raise ValueError(f"policy: {policy!r} is not like my_policy.py:MyPolicy")
    try:
        address_of(policy)
    except ValueError as error:
        raise ValueError(f"policy: {error}") from None
    options_of(given.get("policy_options"))


def options_of(text: str | None) -> dict[str, Any]:
    """The keywords of a policy.

    Raises
    ------
    ValueError
        It is no JSON object.
    """
    try:
        found = json.loads(text or "{}")
    except (ValueError, RecursionError):
        found = None
    if not isinstance(found, dict):
        raise ValueError(f"policy_options: {text!r} is no JSON object")  # noqa: TRY004
    return found
