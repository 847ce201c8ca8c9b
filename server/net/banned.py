"""Bans as those who serve people keep them: who is not let in, who goes, and what they are told."""

from collections.abc import Iterable
from datetime import UTC, datetime
from typing import Any

from esplanade.protocol import ByeCode, CloseCode, ErrorCode, ProtocolError
from esplanade.protocol.messages import Bye
from esplanade.server.moderation.bans import Ban, Bans
from esplanade.server.net import frames
from esplanade.server.net.seats import digest_of


def check_ban(bans: Bans, now_us: int, name: str, address: str, resume: str | None) -> None:
    """Check that no ban keeps a newcomer out; `resume` is the token that they give.

    Raises
    ------
    ProtocolError
        One does, and why and until when.
    """
    digest = None if resume is None else digest_of(resume).hex()
    ban = bans.against(name, address, digest, now_us)
    if ban is not None:
        code, close = ErrorCode.BANNED, CloseCode.BANNED
        raise ProtocolError(code, said_of(ban), close, arguments_of(ban))


def is_banned(
    bans: Bans, now_us: int, names: Iterable[str], address: str, digests: Iterable[str]
) -> bool:
    """Whether any of some bans is of somebody who is in, by what they can be known again."""
    tokens = tuple(digests) or (None,)
    return any(
        bans.against(name, address, digest, now_us) is not None
        for name in names
        for digest in tokens
    )


def farewell_of(ban: Ban) -> bytes:
    """The last frame for whoever is sent out by a ban."""
    farewell = Bye(reason=ByeCode.BANNED, text=said_of(ban), arguments=arguments_of(ban))
    return frames.message(farewell)


def only(ban: Ban) -> Bans:
    """One ban, to be searched for as all are."""
    bans = Bans()
    bans.put(ban)
    return bans


def arguments_of(ban: Ban) -> dict[str, Any]:
    """The arguments of what somebody is told whom a ban keeps out."""
    until_s = None if ban.until_us is None else ban.until_us / 1e6
    return {"text": ban.text, "until_s": until_s}


def said_of(ban: Ban) -> str:
    """The same in words."""
    if ban.until_us is None:
        return ban.text
    end = datetime.fromtimestamp(ban.until_us / 1e6, UTC)
    return f"{ban.text} (until {end:%Y-%m-%d %H:%M} UTC)"
