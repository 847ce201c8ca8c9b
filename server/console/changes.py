"""The changes that were made lately: what each replaced, so that it can be taken back."""

from collections import OrderedDict
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Final, Literal

from esplanade.protocol.commands import Facts
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.state import OperatedState, each

REMEMBERED: Final = 10_000
"""Of more changes the oldest are forgotten here; the audit keeps them all."""


@dataclass(slots=True)
class Change:
    """One change that was made."""

    number: int
    account: str | None
    op: str
    before: Facts
    after: Facts
    reverts: int | None = None
    """The change that this one takes back."""
    reverted_by: int | None = None
    at_us: int = 0
    tick: int | None = None
    note: str | None = None


class Changes:
    """Changes by their numbers, which grow; the latest number is the revision."""

    def __init__(self) -> None:
        self.revision = 0
        self._changes: OrderedDict[int, Change] = OrderedDict()
        self._touched: dict[str, int] = {}
        """The latest change of each parameter in any scope."""

    def add(self, change: Change) -> None:
        """Remember a change that the world has carried out."""
        self.revision = max(self.revision, change.number)
        self._changes[change.number] = change
        for _, field, _ in each(change.after):
            self._touched[field] = change.number
        reverted = None if change.reverts is None else self._changes.get(change.reverts)
        if reverted is not None:
            reverted.reverted_by = change.number
        if len(self._changes) > REMEMBERED:
            self._changes.popitem(last=False)

    def moved(self, change: Change, before: Facts, after: Facts) -> None:
        """A change that goes on has gone further; `before` are facts that it touches newly."""
        for subject, field, value in each(after):
            if field not in change.after.get(subject, {}):
                change.before.setdefault(subject, {})[field] = before[subject][field]
            change.after.setdefault(subject, {})[field] = value
            self._touched[field] = change.number

    def get(self, number: int) -> Change | None:
        """The change with that number, if it is remembered."""
        return self._changes.get(number)

    def newest_first(self) -> Iterator[Change]:
        """All changes that are remembered."""
        return reversed(self._changes.values())

    def save(self) -> dict[str, Any]:
        """All of it as plain data."""
        changes = [asdict(change) for change in self._changes.values()]
        return {"revision": self.revision, "changes": changes}

    def load(self, data: Mapping[str, Any]) -> None:
        """Take in what was saved, in place of what is there."""
        self._changes.clear()
        self._touched.clear()
        for found in data["changes"]:
            change = Change(**found)
            self._changes[change.number] = change
            for _, field, _ in each(change.after):
                self._touched[field] = change.number
        self.revision = data["revision"]

    def check_revision(self, known: int | None, facts: Facts, state: OperatedState) -> None:
        """See that nobody has changed these parameters since a revision.

        Raises
        ------
        RefusedError
            Somebody has; both values of each are told.
        """
        if known is None:
            return
        late = [
            {
                "subject": subject,
                "field": field,
                "yours": value,
                "now": state.fact(subject, field),
                "change": self._touched[field],
            }
            for subject, field, value in each(facts)
            if self._touched.get(field, 0) > known
        ]
        if late:
            names = ", ".join(str(one["field"]) for one in late)
            raise RefusedError.of(
                "conflict",
                f"changed since revision {known}: {names}",
                "if_revision",
                revision=self.revision,
                differences=late,
            )

    def found(
        self, wanted: int | Literal["latest", "undone", "latest_of_all"], account: str | None
    ) -> Change:
        """The change that is to be taken back.

        Raises
        ------
        RefusedError
            There is none, or it is taken back already.
        """
        if isinstance(wanted, int):
            change = self._changes.get(wanted)
            if change is None:
                text = f"there is no change {wanted}, or it is too long ago"
                raise RefusedError.of("unknown_change", text, "change", change=wanted)
            if change.reverted_by is not None:
                text = f"change {wanted} is taken back already, by change {change.reverted_by}"
                raise RefusedError.of("conflict", text, "change", by=change.reverted_by)
            return change
        for change in self.newest_first():
            if not change.after:  # such as a mark
                continue
            mine = wanted == "latest_of_all" or change.account == account
            own = mine and change.reverted_by is None
            if own and wanted != "undone" and not self._takes_back(change):
                return change
            if own and wanted == "undone" and self._takes_back(change):
                return change
            if own and change.reverts is None:  # a new change ends what could be made anew
                break
        whose = "there is" if wanted == "latest_of_all" else "you have made"
        text = f"{whose} no change that could be taken back"
        if wanted == "undone":
            text = "you have taken nothing back that could be made anew"
        raise RefusedError.of("unknown_change", text, "change")

    def can_revert(self, change: Change, state: OperatedState) -> bool:
        """Whether a change could be taken back now, by whoever has the rights."""
        if change.reverted_by is not None or not change.after:
            return False
        return all(
            state.fact(subject, field) == value for subject, field, value in each(change.after)
        )

    def check_untouched(self, change: Change, state: OperatedState, pending: Facts) -> None:
        """See that all is still as a change has made it, after the facts of commands before.

        Raises
        ------
        RefusedError
            Somebody has changed some of it since; the differences are told.
        """
        now = state.now(change.after)
        for subject, fields in pending.items():
            for field in fields.keys() & now.get(subject, {}).keys():
                now[subject][field] = fields[field]
        differences = [
            {
                "subject": subject,
                "field": field,
                "before": change.before[subject][field],
                "after": after,
                "now": now[subject][field],
            }
            for subject, field, after in each(change.after)
            if now[subject][field] != after
        ]
        if differences:
            names = ", ".join(f"{one['field']} of {one['subject']}" for one in differences)
            raise RefusedError.of(
                "conflict",
                f"changed since change {change.number}: {names}",
                "change",
                change=change.number,
                differences=differences,
            )

    def _takes_back(self, change: Change) -> bool:
        """Whether a change is an undo; making anew what was taken back is none."""
        if change.reverts is None:
            return False
        reverted = self._changes.get(change.reverts)
        return reverted is None or not self._takes_back(reverted)
