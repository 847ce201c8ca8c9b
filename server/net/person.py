"""A person as one zone hands them on to another."""

from dataclasses import dataclass

from esplanade.server.accounts.identity import Identity


@dataclass(frozen=True, slots=True)
class Person:
    """All that goes along with a person from zone to zone; whatever is to go along is added here.

    The id is that of the avatar, which is the same in all zones: so the body, which is drawn by the
    id, and what others have muted or reported by it, go along too.
    """

    id: int
    name: str
    address: str
    """The address of the client that has the seat."""
    digests: tuple[bytes, ...]
    """Hashes of the tokens that take the seat, as in `Seat`."""
    operator: Identity | None
    """The operator who has walked in by a pass, as in `Seat`."""
    muted: frozenset[int]
    """Ids of those whom the person does not want to hear."""
    waited_s: float | None
    """For how long the avatar has waited for its person; None for one who is there."""
    silent_s: float
    """For how many seconds nobody hears the person yet, since an operator has muted them."""
    kept_in: str = ""
    """The zone that the store's row of the seat names; empty where nothing is kept."""
