"""People by their avatars' ids as moderators know them, also for a while after they have left."""

import hashlib
import secrets
from collections import OrderedDict
from dataclasses import dataclass, field
from typing import Final

REMEMBERED: Final = 256
"""Of more people who have left, the one who left longest ago is forgotten."""
REMEMBERED_S: Final = 600.0


@dataclass(frozen=True, slots=True)
class KnownPerson:
    """A person, by whatever they can be known again."""

    id: int
    name: str
    wished: str
    """The name that they asked for; the server may have added a number."""
    address: str
    digests: tuple[str, ...] = field(repr=False)
    """SHA-256 of the resume tokens of their seat, hexadecimal."""


class Gone:
    """The people who have left lately."""

    def __init__(self) -> None:
        self._people: OrderedDict[int, tuple[KnownPerson, float]] = OrderedDict()

    def add(self, person: KnownPerson, now_s: float) -> None:
        """Remember somebody who leaves at this moment."""
        self._people[person.id] = person, now_s
        if len(self._people) > REMEMBERED:
            self._people.popitem(last=False)

    def get(self, person: int, now_s: float) -> KnownPerson | None:
        """The one who had that avatar, if they left within the last minutes."""
        found = self._people.get(person)
        return None if found is None or now_s - found[1] > REMEMBERED_S else found[0]


class AddressHashes:
    """Stands for addresses by short texts, which tell whether two are one, for this process."""

    def __init__(self) -> None:
        self._key = secrets.token_bytes(16)

    def of(self, address: str) -> str:
        """The text for an address."""
        return hashlib.blake2s(address.encode(), key=self._key, digest_size=5).hexdigest()
