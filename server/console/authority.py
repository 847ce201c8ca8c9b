"""The rights of an account at the moment when something is done for it without its asking."""

from esplanade.server.accounts.directory import role_of
from esplanade.server.accounts.identity import AccountError, Identity
from esplanade.server.accounts.rights import ROLES, of_text
from esplanade.server.store.store import Store


class Authority:
    """Looks up accounts in the store."""

    def __init__(self, store: Store) -> None:
        self._store = store

    async def identity(self, account: str | None, rights: str, via: str) -> Identity | None:
        """The identity of an account as it is now; None if it is gone.

        It has the rights of its role, but none beside `rights`, which are those of the session or
        token that wanted it so.

        Raises
        ------
        StoreError
            It cannot be looked up.
        """
        if account is None:
            return Identity(account=None, role="", rights=of_text(rights), via=via)
        name = account
        try:
            role = await self._store.read(
                lambda connection: role_of(connection, self._store.world, name)
            )
        except AccountError:
            return None
        held = ROLES.get(role, frozenset()) & of_text(rights)
        return Identity(account=account, role=role, rights=held, via=via)
