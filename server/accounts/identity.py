"""Identities: an account as it came in, with the rights that it has by that way."""

import hashlib
import re
import secrets
from dataclasses import dataclass
from typing import Final

from esplanade.server.accounts.rights import ROLES, Rights, as_text
from esplanade.server.audit.entries import Entry

_NAME: Final = re.compile(r"[a-z][a-z0-9._-]{0,31}")
SECRET_BYTES: Final = 32
"""Secrets that are made here have 256 random bits, so that a plain digest of them is safe."""


class AccountError(Exception):
    """A wish about accounts that cannot be fulfilled; nothing was changed, and the message says
    why to people, a code and its arguments to programs."""

    code = "account"

    def __init__(self, text: str, code: str | None = None, **arguments: object) -> None:
        super().__init__(text)
        self.code = code or type(self).code
        self.arguments = arguments


@dataclass(frozen=True, slots=True, kw_only=True)
class Identity:
    """An account that does something, with its rights at the moment it was looked up."""

    account: str | None
    """The name of the account; None for whoever is on the machine itself."""
    role: str
    rights: Rights
    via: str
    """Its way in: `machine`, `session`, `pass`, or `token` with the name of the token."""
    address: str | None = None

    def entry(self, command: str, *, person: str | None = None, **more: object) -> Entry:
        """An entry of the audit about what this one does with an account or a person, if any;
        `more` becomes its body."""
        return Entry(
            command=command,
            account=self.account,
            role=self.role,
            address=self.address,
            person=person,
            body={"via": self.via, **more},
        )


MACHINE: Final = Identity(account=None, role="", rights=ROLES["admin"], via="machine")
"""Whoever may write the files of the store may do everything with it."""


def is_name(name: str) -> bool:
    """Whether this can be the name of an account or a token."""
    return _NAME.fullmatch(name) is not None


def checked_name(name: str) -> str:
    """The name, of an account or a token, if it can be one.

    Raises
    ------
    AccountError
        It cannot.
    """
    if not is_name(name):
        raise AccountError(
            f"{name!r} is no name of 1 to 32 small letters, digits and . _ - that begins with a "
            "letter",
            "bad_name",
        )
    return name


def checked_role(role: str) -> str:
    """The role, if there is one of that name.

    Raises
    ------
    AccountError
        There is none.
    """
    if role not in ROLES:
        raise AccountError(
            f"{role!r} is no role; there are {', '.join(ROLES)}", "no_role", roles=[*ROLES]
        )
    return role


def new_secret(prefix: str = "") -> str:
    """A secret of 256 random bits in letters, digits, - and _."""
    return prefix + secrets.token_urlsafe(SECRET_BYTES)


def digest_of(secret: str) -> str:
    """Return the SHA-256 digest of a secret in hexadecimal, which is kept in its place."""
    return hashlib.sha256(secret.encode("utf-8", "surrogatepass")).hexdigest()


def check_reach(by: Identity, rights: Rights) -> None:
    """Check that somebody gives to others, or takes from them, no right that is not their own: a
    token for accounts alone is no way to become more than it is.

    Raises
    ------
    AccountError
        It is more than theirs.
    """
    beyond = rights - by.rights
    if beyond:
        text = f"this is about rights that you do not have: {as_text(beyond)}"
        raise AccountError(text, "beyond_reach", rights=as_text(beyond).split())
