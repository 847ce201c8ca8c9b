"""Kinds of those who were recorded, where a file tells them: people, and others."""

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Final

_PEOPLE: Final = frozenset(
    ("ped", "peds", "pedestrian", "pedestrians", "person", "people", "human")
)
_OTHERS: Final = frozenset(
    ("veh", "vehicle", "car", "cart", "biker", "bicycle", "skater", "bus", "truck")
)


def is_person(kind: str) -> bool:
    """Whether a kind is one of people."""
    return kind.strip().lower() in _PEOPLE


def others_among(kinds: Iterable[str]) -> dict[str, int]:
    """The kinds of samples that are no people, with their counts.

    It is empty where the words name neither people nor others that are known, since a column of
    another meaning leaves nobody out.
    """
    found = Counter(kinds)
    if not any(is_person(kind) for kind in found):
        return dict(found) if any(kind.strip().lower() in _OTHERS for kind in found) else {}
    return {kind: count for kind, count in found.items() if not is_person(kind)}


def told_others(others: Mapping[str, int]) -> str:
    """The remark on samples of others that are left out."""
    told = ", ".join(f"{count} of {kind!r}" for kind, count in others.items())
    return f"samples that are not people's are left out: {told}"[:300]
