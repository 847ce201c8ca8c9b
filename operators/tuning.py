"""Commands of a script on parameters, presets, groups and schedules."""

from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import quote

from esplanade.operators.conversation import Conversation
from esplanade.operators.scopes import scope_text
from esplanade.protocol.commands import Answer, Command


class Tuning(Conversation):
    """Commands on parameters, and questions about them."""

    async def set(
        self,
        *,
        group: str | None = None,
        actor: str | None = None,
        note: str | None = None,
        dry_run: bool = False,
        if_revision: int | None = None,
        over_s: float | None = None,
        guard: Mapping[str, Any] | None = None,
        **values: float,
    ) -> Answer:
        """Set parameters of the world, or of a group, or of an actor.

        With `over_s` they go there evenly. A guard, such as `{"figure": "contacts_per_minute",
        "above": 3, "for_s": 10}`, takes the change back by itself.
        """
        return await self.send(
            {
                "op": "set_parameters",
                "scope": scope_text(group, actor),
                "values": values,
                "note": note,
                "dry_run": dry_run,
                "if_revision": if_revision,
                "over_s": over_s,
                "guard": guard,
            }
        )

    async def clear(
        self, *names: str, group: str | None = None, actor: str | None = None
    ) -> Answer:
        """Take values of a scope away, or all of them."""
        scope = scope_text(group, actor)
        return await self.send({"op": "clear_parameters", "scope": scope, "names": names})

    async def undo(self, change: int | None = None, *, anybody: bool = False) -> Answer:
        """Take a change back, or your own latest, or the latest that anybody made."""
        latest = "latest_of_all" if anybody else "latest"
        return await self.send({"op": "revert", "change": change or latest})

    async def redo(self) -> Answer:
        """Make anew what you took back last."""
        return await self.send({"op": "revert", "change": "undone"})

    async def changes(self, limit: int = 50) -> list[dict[str, Any]]:
        """The latest changes, the newest first."""
        return list((await self._ask(f"/changes?limit={limit}"))["changes"])

    async def diff(self, *columns: str) -> dict[str, Any]:
        """Parameters in columns side by side, such as `default`, `preset:timid`, `world@117`."""
        return dict(await self._ask(f"/diff?columns={quote(','.join(columns))}"))

    # --- presets ----------------------------------------------------------------------------------

    async def presets(self) -> list[dict[str, Any]]:
        """All presets, each in the version that holds."""
        return list((await self._ask("/presets"))["presets"])

    async def preset(self, name: str, version: int | None = None) -> dict[str, Any]:
        """One preset with its values."""
        asked = "" if version is None else f"?version={version}"
        return dict(await self._ask(f"/presets/{name}{asked}"))

    async def apply_preset(
        self,
        name: str,
        *,
        group: str | None = None,
        actor: str | None = None,
        version: int | None = None,
        replace: bool = False,
        note: str | None = None,
    ) -> Answer:
        """Set the values of a preset in a scope; with `replace` its other values go."""
        return await self.send(
            {
                "op": "apply_preset",
                "scope": scope_text(group, actor),
                "preset": name,
                "version": version,
                "replace": replace,
                "note": note,
            }
        )

    async def save_preset(
        self,
        name: str,
        values: Mapping[str, float] | None = None,
        *,
        from_scope: str | None = None,
        note: str | None = None,
    ) -> Answer:
        """Keep values, or those that are set in a scope, as the next version of a preset."""
        given = None if values is None else dict(values)
        more = {"values": given, "from_scope": from_scope, "note": note}
        return await self.send({"op": "save_preset", "name": name, **more})

    async def delete_preset(self, name: str) -> Answer:
        """Forget what was saved under a name."""
        return await self.send({"op": "delete_preset", "name": name})

    # --- groups and schedules ---------------------------------------------------------------------

    async def groups(self) -> list[dict[str, Any]]:
        """All groups with their actors."""
        return list((await self._ask("/groups"))["groups"])

    async def group(self, name: str, *actors: str, remove: bool = False) -> Answer:
        """Put actors into a group `purpose:name`, or take them out of it."""
        return await self.send(
            {"op": "set_group", "group": name, "actors": actors, "remove": remove}
        )

    async def schedules(self) -> dict[str, Any]:
        """Schedules, guards, and the figures that conditions may name."""
        return dict(await self._ask("/schedules"))

    async def schedule(
        self,
        *commands: Command | Mapping[str, Any],
        when: Mapping[str, Any],
        again_after_s: float | None = None,
        guard: Mapping[str, Any] | None = None,
        note: str | None = None,
    ) -> Answer:
        """Have commands carried out later, such as `when={"after_s": 600}`."""
        plain: Sequence[Any] = [
            dict(each) if isinstance(each, Mapping) else each.model_dump(mode="json")
            for each in commands
        ]
        return await self.send(
            {
                "op": "schedule",
                "commands": plain,
                "when": dict(when),
                "again_after_s": again_after_s,
                "guard": guard,
                "note": note,
            }
        )

    async def cancel(self, schedule: str) -> Answer:
        """Let a schedule do nothing any more."""
        return await self.send({"op": "cancel_schedule", "id": schedule})
