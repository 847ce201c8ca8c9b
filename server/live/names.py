"""Names of people, which may be hidden from operators who do not moderate."""

from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right


def sees_names(by: Identity, hide_names: bool) -> bool:
    """Whether an operator is told the names of people, and what they say of each other's."""
    return not hide_names or Right.MODERATE in by.rights


def stand_in(avatar_id: int) -> str:
    """The name that is shown in the place of a person's own."""
    return f"Person {avatar_id}"
