"""A queue in which addresses take turns, and so do the people of one address."""

from collections import OrderedDict
from collections.abc import Container
from typing import Generic, NamedTuple, TypeVar

T = TypeVar("T")


class Asker(NamedTuple):
    """Somebody who wants something from the server."""

    address: str
    avatar_id: int


class FairQueue(Generic[T]):
    """At most one thing for each person, the latest; it keeps the place of the one before."""

    def __init__(self) -> None:
        self._waiting: OrderedDict[str, OrderedDict[int, T]] = OrderedDict()
        self._addresses: dict[int, str] = {}

    def __len__(self) -> int:
        return len(self._addresses)

    def put(self, asker: Asker, thing: T) -> None:
        """Let something wait; it takes the place of what this person wanted before."""
        if self._addresses.get(asker.avatar_id, asker.address) != asker.address:
            self.discard(asker.avatar_id)
        self._waiting.setdefault(asker.address, OrderedDict())[asker.avatar_id] = thing
        self._addresses[asker.avatar_id] = asker.address

    def pop(self, but_for: Container[str] = ()) -> tuple[Asker, T] | None:
        """Take out whose turn it is, of addresses other than `but_for`; None if there is none."""
        address = next((one for one in self._waiting if one not in but_for), None)
        if address is None:
            return None
        people = self._waiting[address]
        avatar_id, thing = people.popitem(last=False)
        del self._addresses[avatar_id]
        self._waiting.move_to_end(address)
        if not people:
            del self._waiting[address]
        return Asker(address, avatar_id), thing

    def discard(self, avatar_id: int) -> None:
        """Take out what a person waits for, if anything."""
        address = self._addresses.pop(avatar_id, None)
        if address is not None:
            people = self._waiting[address]
            del people[avatar_id]
            if not people:
                del self._waiting[address]
