"""The changes that were made lately: what each replaced, so that it can be taken back."""

from collections import OrderedDict
from dataclasses import dataclass
from typing import Final, Literal

from esplanade.protocol.commands import Command, Facts
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.state import OperatedState, each

REMEMBERED: Final = 10_000
"""Of more changes the oldest are forgotten here; the audit keeps them all."""


@dataclass(slots=True)
class Change:
    """One change that was made."""

    number: int
    account: str | None
    command: Command
    before: Facts
    after: Facts
    reverts: int | None = None
    """The change that this one takes back."""
    reverted_by: int | None = None


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

    def found(self, wanted: int | Literal["latest", "undone"], account: str | None) -> Change:
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
        for change in reversed(self._changes.values()):
            own = change.account == account and change.reverted_by is None
            if own and wanted == "latest" and not self._takes_back(change):
                return change
            if own and wanted == "undone" and self._takes_back(change):
                return change
            if own and change.reverts is None:  # a new change ends what could be made anew
                break
        text = "you have made no change that could be taken back"
        if wanted == "undone":
            text = "you have taken nothing back that could be made anew"
        raise RefusedError.of("unknown_change", text, "change")

    def check_untouched(self, change: Change, state: OperatedState) -> None:
        """See that all is still as a change has made it.

        Raises
        ------
        RefusedError
            Somebody has changed some of it since; the differences are told.
        """
        now = state.now(change.after)
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
