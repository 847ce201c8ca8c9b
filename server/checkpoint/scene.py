"""The key of a scene: a checkpoint fits the one scene that it was taken of."""

import hashlib
from typing import NamedTuple, Self


class SceneKey(NamedTuple):
    """A scene's name for people, and a digest of all that it consists of."""

    name: str
    digest: str

    @classmethod
    def of(cls, name: str, described: str, triangles: bytes | None) -> Self:
        """The key of a scene described in JSON, and of the triangles of its mesh."""
        found = hashlib.sha256(described.encode())
        found.update(b"\0" if triangles is None else triangles)
        return cls(name, found.hexdigest())
