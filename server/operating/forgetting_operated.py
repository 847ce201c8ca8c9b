"""Forgets an operator in what operators have made: presets, schedules, guards."""

import json
from typing import Any

from sqlalchemy import Connection, select, update

from esplanade.server.store.tables import OPERATED
from esplanade.server.store.zone_store import anywhere_in


def forget_operated(connection: Connection, zone: str, person: str) -> int:
    """Take the name away from presets, schedules and guards that an account of that name has made.

    What has no name acts for nobody: a schedule is refused when it is due. Returns how many rows
    were changed.
    """
    columns = OPERATED.c.zone, OPERATED.c.part, OPERATED.c.name, OPERATED.c.body
    query = select(*columns).where(anywhere_in(OPERATED.c.zone, zone))
    count = 0
    for there, part, name, text in connection.execute(query).all():
        body = json.loads(text)
        if _without(body, person):
            key = {"zone": there, "part": part, "name": name}
            connection.execute(update(OPERATED).filter_by(**key).values(body=json.dumps(body)))
            count += 1
    return count


def _without(body: dict[str, Any], person: str) -> bool:
    """Whether the name was in a body, or in a version of a preset; it is taken away there."""
    found = False
    for each in (body, *body.get("versions", ())):
        if each.get("by") == person:
            for field in {"by", "note"} & each.keys():
                each[field] = None
            if "rights" in each:
                each["rights"] = ""
            found = True
    return found
