"""Accounts and their tokens over HTTP; all of it needs the right for accounts."""

from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Path, Request
from pydantic import BaseModel, Field

from esplanade.server.accounts.identity import AccountError
from esplanade.server.accounts.passwords import checked_password
from esplanade.server.accounts.rights import Right, as_text
from esplanade.server.accounts.tokens import DAY_US, LONGEST_US, Token
from esplanade.server.audit.log import now_us
from esplanade.server.console.auth_api import Body, Password, Word
from esplanade.server.console.routing import PREFIX, REFUSALS, Guarded, gate_of, may

router = APIRouter(prefix=PREFIX, route_class=Guarded, responses=REFUSALS)
Name = Annotated[str, Path(max_length=64)]


class TokenFacts(BaseModel):
    """A token of a script that is not revoked; the token itself is kept nowhere."""

    name: str
    rights: list[str]
    expires_us: int
    last_us: int | None


class AccountFacts(BaseModel):
    """One account."""

    name: str
    role: str
    created_us: int
    last_us: int | None
    has_password: bool
    tokens: list[TokenFacts]


class AllAccounts(BaseModel):
    """All accounts, by name."""

    accounts: list[AccountFacts]


class NewAccount(Body):
    """An account; without a password it comes in by tokens only."""

    name: Word
    role: Word
    password: Password | None = None


class ChangedAccount(Body):
    """Changes to an account."""

    role: Word | None = None
    password: Password | None = None


class NewToken(Body):
    """A token; without `rights` it has all of its account's."""

    name: Word
    rights: list[Annotated[Right, Field(strict=False)]] | None = None
    expires_days: Annotated[int, Field(ge=1, le=LONGEST_US // DAY_US)] = 90


class MadeToken(BaseModel):
    """The token, which is told this once."""

    token: str


@router.get("/accounts")
async def accounts(request: Request) -> AllAccounts:
    """All accounts, and their tokens that are not revoked."""
    may(request, Right.ACCOUNTS)
    kept = gate_of(request).kept
    tokens: dict[str, list[TokenFacts]] = {}
    for token in await kept.tokens.list():
        if token.is_usable(now_us()):
            tokens.setdefault(token.account, []).append(_facts(token))
    found = [
        AccountFacts(
            name=each.name,
            role=each.role,
            created_us=each.created_us,
            last_us=each.seen_us,
            has_password=each.has_password,
            tokens=tokens.get(each.name, []),
        )
        for each in await kept.directory.list()
    ]
    return AllAccounts(accounts=found)


@router.post("/accounts", status_code=HTTPStatus.CREATED)
async def add_account(request: Request, body: NewAccount) -> None:
    """Add an account."""
    by = may(request, Right.ACCOUNTS)
    await gate_of(request).kept.directory.add(by, body.name, body.role, body.password)


@router.patch("/accounts/{name}", status_code=HTTPStatus.NO_CONTENT)
async def change_account(request: Request, name: Name, body: ChangedAccount) -> None:
    """Give an account another role, another password, or both; its sessions end with the latter."""
    by = may(request, Right.ACCOUNTS)
    if body.role is None and body.password is None:
        raise AccountError("give a role or a password")
    if body.password is not None:
        checked_password(body.password)
    directory = gate_of(request).kept.directory
    if body.role is not None:
        await directory.set_role(by, name, body.role)
    if body.password is not None:
        await directory.set_password(by, name, body.password)


@router.delete("/accounts/{name}", status_code=HTTPStatus.NO_CONTENT)
async def remove_account(request: Request, name: Name) -> None:
    """Remove an account with its sessions and tokens."""
    by = may(request, Right.ACCOUNTS)
    await gate_of(request).kept.directory.remove(by, name)


@router.post("/accounts/{name}/tokens", status_code=HTTPStatus.CREATED)
async def add_token(request: Request, name: Name, body: NewToken) -> MadeToken:
    """Make a token of an account."""
    by = may(request, Right.ACCOUNTS)
    rights = None if body.rights is None else frozenset(body.rights)
    made = await gate_of(request).kept.tokens.add(
        by, name, body.name, rights=rights, lasts_us=body.expires_days * DAY_US
    )
    return MadeToken(token=made)


@router.delete("/accounts/{name}/tokens/{token}", status_code=HTTPStatus.NO_CONTENT)
async def revoke_token(request: Request, name: Name, token: Name) -> None:
    """Make a token useless, at once."""
    by = may(request, Right.ACCOUNTS)
    await gate_of(request).kept.tokens.revoke(by, name, token)


def _facts(token: Token) -> TokenFacts:
    return TokenFacts(
        name=token.name,
        rights=as_text(token.rights).split(),
        expires_us=token.expires_us,
        last_us=token.used_us,
    )
