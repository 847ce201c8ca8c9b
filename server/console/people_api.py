"""The part of the HTTP interface about people: the inbox, bans, chat and its rules."""

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request

from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right
from esplanade.server.console.console import Console
from esplanade.server.console.gate import Gate
from esplanade.server.console.refusals import RefusedError
from esplanade.server.moderation.chat_rules import as_data

Question = Callable[[Console], dict[str, Any]]


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
        for report in console.moderation.kept.inbox
        if state is None or report.state == state
    ]
    return {"reports": found[::-1], "open": console.moderation.kept.inbox.open}


def bans(console: Console) -> dict[str, Any]:
    """All bans, the newest first."""
    kept = console.moderation.kept
    now_us = kept.now_us()
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
        for ban in kept.bans
    ]
    return {"bans": sorted(found, key=lambda ban: -ban["id"])}


def chat(console: Console, *, limit: int = 500) -> dict[str, Any]:
    """The last lines of chat, the newest first, where this server keeps chat."""
    kept = console.moderation.kept.chat
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
        for line in list(kept)[-limit:]
    ]
    return {"keeps_chat": kept.keeps, "lines": lines[::-1]}


def rules(console: Console) -> dict[str, Any]:
    """The rules of chat."""
    kept = console.moderation.kept
    return {
        "slow_mode_s": kept.rules.every_s,
        "words": list(kept.rules.words.words),
        "action": kept.rules.words.action,
        "quiet_zones": [{"name": name, **as_data(area)} for name, area in kept.rules.quiet.items()],
        "keeps_chat": kept.chat.keeps,
    }


def people_router(router: APIRouter) -> APIRouter:
    """Add these paths to a router, which knows who asks."""

    @router.get("/reports")
    async def get_reports(
        request: Request, state: Annotated[str | None, Query(pattern="^(open|done)$")] = None
    ) -> dict[str, Any]:
        """What people report, the newest first; it needs the right *moderate*."""
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
        return await _asked(request, rules)

    return router


async def _asked(request: Request, question: Question) -> dict[str, Any]:
    identity: Identity = request.state.identity
    if Right.MODERATE not in identity.rights:
        text = f"this needs the right {Right.MODERATE.value}, which you do not have"
        raise RefusedError.of("forbidden", text, right=Right.MODERATE.value)

    async def ask(console: Console) -> dict[str, Any]:
        return await console.ask(lambda: question(console))

    gate: Gate = request.app.state.gate
    return await gate.call(ask)
