"""Policies that take options of the command line: those from outside, and some of ours."""

from typing import Final

from esplanade.policies.names import is_outside

WITH_OPTIONS: Final = ("orca",)
"""Those of our policies that take options as policies from outside do."""


def has_options(name: str) -> bool:
    """Whether a policy takes options of the command line."""
    return name in WITH_OPTIONS or is_outside(name)
