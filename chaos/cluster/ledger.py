"""The ledger of bots in a cluster: what each was told, and what of that cannot be."""

import time
from collections import Counter, defaultdict
from dataclasses import dataclass, field

from esplanade.protocol.messages import Entity, Welcome


@dataclass
class Account:
    """All that one bot has been told; it lives on when its connection ends."""

    name: str
    person: int | None = None
    token: str | None = None
    zone: str | None = None
    """The scene in which it is, as the newest welcome says; None without a connection."""
    given_name: str | None = None
    seen: dict[int, Entity] = field(default_factory=dict)
    """Whom it has in view."""
    heard: Counter[str] = field(default_factory=Counter)
    """The number of times that it has heard each line."""
    welcomes: int = 0
    snapshot_s: float | None = None
    """When it last got a snapshot; None while it has no connection."""
    worst_gap_s: float = 0.0
    """The longest time without a snapshot since it was last asked for, reconnecting included."""


class Ledger:
    """Takes in what bots are told, and notes faults: doubles, ghosts, losses."""

    def __init__(self) -> None:
        self.accounts: dict[str, Account] = {}
        self.faults: list[str] = []
        self.counts: Counter[str] = Counter()
        """Welcomes, refusals, hops, lines said and heard, by those words."""
        self.said: defaultdict[str, set[str]] = defaultdict(set)
        """The lines of each bot."""

    def account(self, name: str) -> Account:
        """The account of a bot, which begins with the first call."""
        return self.accounts.setdefault(name, Account(name))

    def welcomed(self, account: Account, welcome: Welcome) -> None:
        """Note a welcome: whoever comes back is whom they were."""
        self.counts["welcomes"] += 1
        account.welcomes += 1
        account.zone = str(welcome.scene["name"])
        if account.token is not None:
            if not welcome.resumed and welcome.id != account.person:
                self._fault(f"{account.name} has lost the seat of person {account.person}")
            elif (welcome.id, welcome.name) != (account.person, account.given_name):
                told = f"{welcome.id} {welcome.name!r}"
                before = f"{account.person} {account.given_name!r}"
                self._fault(f"{account.name} was {before} and has come back as {told}")
        account.person, account.given_name = welcome.id, welcome.name
        account.token = welcome.resume
        account.seen = {}

    def entered(self, account: Account, entities: list[Entity]) -> None:
        """Note who has come into view: nobody is there twice."""
        account.seen.update((entity.id, entity) for entity in entities)
        names = Counter(each.name for each in account.seen.values() if each.kind == "person")
        for name, number in names.items():
            if number > 1:
                self._fault(f"{account.name} sees {number} people called {name!r}")

    def heard(self, account: Account, speaker: str, line: str) -> None:
        """Note a line: nobody hears one twice, and all were said."""
        self.counts["lines heard"] += 1
        account.heard[line] += 1
        if account.heard[line] > 1:
            self._fault(f"{account.name} has heard {line!r} {account.heard[line]} times")
        if line not in self.said[speaker]:
            self._fault(f"{account.name} has heard {line!r} of {speaker}, who never said it")

    def shown(self, account: Account) -> None:
        """Note a snapshot."""
        now_s = time.monotonic()
        if account.snapshot_s is not None:
            account.worst_gap_s = max(account.worst_gap_s, now_s - account.snapshot_s)
        account.snapshot_s = now_s

    def worst_gap_s(self) -> float:
        """The longest time that any bot was without a snapshot since the last call."""
        now_s, worst_s = time.monotonic(), 0.0
        for account in self.accounts.values():
            since_s = 0.0 if account.snapshot_s is None else now_s - account.snapshot_s
            worst_s = max(worst_s, account.worst_gap_s, since_s)
            account.worst_gap_s = 0.0
        return worst_s

    def check_rest(self, seats: list[str]) -> None:
        """Note as faults what cannot be when nothing has happened for a while."""
        self.faults += self.unrest(seats)

    def unrest(self, seats: list[str]) -> list[str]:
        """The things that cannot be when nothing has happened for a while, a sentence each.

        Every bot is in, each has one seat and nobody else has any, and each sees those who are in
        the same zone and nobody else.
        """
        found: list[str] = []
        in_zones: defaultdict[str, set[str]] = defaultdict(set)
        for account in self.accounts.values():
            if account.zone is None or account.given_name is None:
                found.append(f"{account.name} is not in")
            else:
                in_zones[account.zone].add(account.given_name)
        expected = sorted(each.given_name or each.name for each in self.accounts.values())
        if expected != seats:
            found.append(f"there are seats of {seats}, and bots called {expected}")
        for account in self.accounts.values():
            seen = {each.name for each in account.seen.values() if each.kind == "person"}
            there = in_zones[account.zone or ""]
            found += [
                f"{account.name} sees {ghost}, who is not in {account.zone}"
                for ghost in sorted(seen - there)
            ]
            found += [
                f"{account.name} does not see {missing} in {account.zone}"
                for missing in sorted(there - seen)
            ]
        return found

    def _fault(self, text: str) -> None:
        self.faults.append(text)
