"""Accounts of operators, their tokens, invitations and bots, over the network."""

from collections.abc import Awaitable, Callable, Sequence
from typing import Any
from urllib.parse import quote

Ask = Callable[..., Awaitable[Any]]


class Accounts:
    """The accounts of others, for an operator who has the right to change them.

    Each method raises `RefusedError` where the server refuses.
    """

    def __init__(self, ask: Ask) -> None:
        self._ask = ask

    async def list(self) -> list[dict[str, Any]]:
        """All accounts with their usable tokens."""
        return list((await self._ask("/accounts"))["accounts"])

    async def add(self, name: str, role: str, password: str | None = None) -> None:
        """Add an account; without a password it comes in by tokens only."""
        await self._ask("/accounts", {"name": name, "role": role, "password": password})

    async def set_role(self, name: str, role: str) -> None:
        """Give an account another role, at once."""
        await self._ask(_of(name), {"role": role}, "PATCH")

    async def set_password(self, name: str, password: str) -> None:
        """Give an account another password; its sessions end."""
        await self._ask(_of(name), {"password": password}, "PATCH")

    async def remove(self, name: str) -> None:
        """Remove an account with its sessions and tokens."""
        await self._ask(_of(name), None, "DELETE")

    async def add_token(
        self, account: str, name: str, *, rights: Sequence[str] | None = None, days: int = 90
    ) -> str:
        """Make a token; it is told this once. Without `rights` it has all of its account's."""
        body = {"name": name, "expires_days": days}
        if rights is not None:
            body["rights"] = [*rights]
        return str((await self._ask(f"{_of(account)}/tokens", body))["token"])

    async def revoke_token(self, account: str, name: str) -> None:
        """Make a token useless, at once."""
        await self._ask(f"{_of(account)}/tokens/{quote(name, safe='')}", None, "DELETE")

    async def invite(self, *, uses: int = 1, hours: int = 24, label: str | None = None) -> str:
        """Make an invitation to a closed world; its link is told this once."""
        body = {"uses": uses, "expires_hours": hours, "label": label}
        return str((await self._ask("/invitations", body))["url"])

    async def add_bot(
        self, name: str, *, message_rate: int = 60, connections: int = 1, days: int = 90
    ) -> str:
        """Make a token by which a bot comes in; it is told this once."""
        body = {"name": name, "message_rate": message_rate, "connections": connections}
        return str((await self._ask("/bots", {**body, "expires_days": days}))["token"])


def _of(name: str) -> str:
    return f"/accounts/{quote(name, safe='')}"
