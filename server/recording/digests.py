"""Digests of the exact state of a zone, and the names of what differs between two states."""

import hashlib
from collections.abc import Iterator, Mapping
from typing import Any, Final

import numpy as np

from esplanade.server.checkpoint.format import packed
from esplanade.server.world.exact_state import NAMES

_BYTES: Final = 4
"""Of each part's digest: one of 2^32 changes of a part would not be seen in it."""
MOST_NAMED: Final = 12
"""Of more fields that differ, no more than these are named."""


def digests(saved: Mapping[str, Any]) -> dict[str, str]:
    """The digest of each part of an exact state but people's names, as hexadecimal digits."""
    return {
        name: hashlib.blake2b(packed(part), digest_size=_BYTES).hexdigest()
        for name, part in saved.items()
        if name != NAMES
    }


def differences(one: Mapping[str, Any], other: Mapping[str, Any]) -> list[str]:
    """The fields in which two exact states differ, such as `avatars.positions`, at most a few."""
    found = []
    for field in _differing(one, other, ()):
        if field[0] != NAMES:
            found.append(".".join(field))
        if len(found) >= MOST_NAMED:
            break
    return found


def _differing(one: Any, other: Any, path: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        for key in dict.fromkeys([*one, *other]):
            if key not in one or key not in other:
                yield (*path, str(key))
            else:
                yield from _differing(one[key], other[key], (*path, str(key)))
    elif packed(_plain(one)) != packed(_plain(other)):
        yield path


def _plain(value: Any) -> Any:
    return np.ascontiguousarray(value) if isinstance(value, np.ndarray) else value
