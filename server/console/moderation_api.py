"""The part of the HTTP interface about people: the inbox, bans, chat and its rules."""

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request

from esplanade.server.accounts.rights import Right
from esplanade.server.console.console import Console
from esplanade.server.console.routing import PREFIX, REFUSALS, Guarded, asked
from esplanade.server.moderation.chat_rules import as_data

Question = Callable[[Console], dict[str, Any]]

router = APIRouter(prefix=PREFIX, route_class=Guarded, responses=REFUSALS)


def reports(console: Console, *, state: str | None = None) -> dict[str, Any]:
    """The reports of people, the newest first; those in a state, or all."""
    found = [
        {
            "id": report.id,
            "at_us": report.at_us,
            "reporter": {"id": report.reporter, "name": report.reporter_name},
            "person": report.person,
            "name": report.name,
            "line": report.line,
            "said": report.said,
            "text": report.text,
            "place": None if report.place is None else list(report.place),
            "state": report.state,
            "settled_by": report.settled_by,
        }
        for report in console.moderation.state.inbox
        if state is None or report.state == state
    ]
    return {"reports": found[::-1], "open": console.moderation.state.inbox.open}


def bans(console: Console) -> dict[str, Any]:
    """All bans, the newest first."""
    decided = console.moderation.state
    now_us = decided.now_us()
    found = [
        {
            "id": ban.id,
            "kinds": [
                kind
                for kind, there in (
                    ("token", ban.digests),
                    ("name", ban.name_pattern),
                    ("address", ban.address),
                )
                if there
            ],
            "name_pattern": ban.name_pattern,
            "address": ban.address,
            "text": ban.text,
            "until_s": None if ban.until_us is None else ban.until_us / 1e6,
            "at_us": ban.at_us,
            "by": ban.by,
            "lifted": ban.lifted,
            "holds": ban.holds(now_us),
        }
        for ban in decided.bans
    ]
    return {"bans": sorted(found, key=lambda ban: -ban["id"])}


def chat(console: Console, *, limit: int = 500) -> dict[str, Any]:
    """The last lines of chat, the newest first, where this server keeps chat."""
    decided = console.moderation.state.chat
    lines = [
        {
            "line": line.line,
            "at_us": line.at_us,
            "tick": line.tick,
            "id": line.id,
            "name": line.name,
            "text": line.text,
            "hidden": line.hidden,
            "seen_by": len(line.seen),
            "seen": list(line.seen),
        }
        for line in list(decided)[-limit:]
    ]
    return {"keeps_chat": decided.keeps, "lines": lines[::-1]}


def rules_of_chat(console: Console) -> dict[str, Any]:
    """The rules of chat."""
    decided = console.moderation.state
    rules = decided.rules
    return {
        "slow_mode_s": rules.every_s,
        "words": list(rules.words.words),
        "action": rules.words.action,
        "quiet_zones": [{"name": name, **as_data(area)} for name, area in rules.quiet.items()],
        "keeps_chat": decided.chat.keeps,
    }


@router.get("/reports")
async def get_reports(
    request: Request, state: Annotated[str | None, Query(pattern="^(open|done)$")] = None
) -> dict[str, Any]:
    """The reports of people, the newest first; it needs the right *moderate*."""
    return await _asked(request, lambda console: reports(console, state=state))


@router.get("/bans")
async def get_bans(request: Request) -> dict[str, Any]:
    """All bans, also those that are over; it needs the right *moderate*."""
    return await _asked(request, bans)


@router.get("/chat")
async def get_chat(
    request: Request, limit: Annotated[int, Query(ge=1, le=500)] = 500
) -> dict[str, Any]:
    """The last lines of chat and who was sent them; it needs the right *moderate*."""
    return await _asked(request, lambda console: chat(console, limit=limit))


@router.get("/moderation")
async def get_rules(request: Request) -> dict[str, Any]:
    """The rules of chat: slow mode, words, quiet zones; it needs the right *moderate*."""
    return await _asked(request, rules_of_chat)


async def _asked(request: Request, question: Question) -> dict[str, Any]:
    return await asked(request, question, Right.MODERATE)
