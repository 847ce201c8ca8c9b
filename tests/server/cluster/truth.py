"""The truth of a cluster in plain Python: the twin of the statements in SQL."""

from collections.abc import Collection
from dataclasses import dataclass, replace

from esplanade.server.cluster.ownership import LEASE_US, NotOwnerError, Ownership
from esplanade.server.cluster.seats import ClusterSeat
from esplanade.server.cluster.tenure import Claim


@dataclass
class Keys:
    """The tokens that take a seat."""

    newest: str
    used: str | None = None


class Truth:
    """Owners and seats, with a clock in microseconds that is moved by hand."""

    def __init__(self, now_us: int) -> None:
        self.now_us = now_us
        self.zones: dict[str, Ownership] = {}
        self.seats: dict[int, ClusterSeat] = {}
        self.keys: dict[int, Keys] = {}

    def add_zone(self, zone: str) -> bool:
        if zone in self.zones:
            return False
        self.zones[zone] = Ownership(zone, 0, None, 0, None)
        return True

    def claim(self, host: str, zones: Collection[str] | None = None) -> Claim | None:
        free = [
            (row.until_us, row.zone)
            for row in self.zones.values()
            if row.until_us < self.now_us
            and row.wanted_host in {None, host}
            and (zones is None or row.zone in zones)
        ]
        if not free:
            return None
        row = self.zones[min(free)[1]]
        epoch = max(row.epoch + 1, self.now_us // 1000)
        until = self.now_us + LEASE_US
        self.zones[row.zone] = replace(row, epoch=epoch, host=host, until_us=until)
        return Claim(row.zone, host, epoch)

    def owns(self, claim: Claim) -> bool:
        row = self.zones[claim.zone]
        return (row.host, row.epoch) == (claim.host, claim.epoch)

    def renew(self, claim: Claim) -> bool:
        if not self.owns(claim):
            return False
        row = self.zones[claim.zone]
        self.zones[claim.zone] = replace(row, until_us=self.now_us + LEASE_US)
        return True

    def release(self, claim: Claim) -> bool:
        if not self.owns(claim):
            return False
        self.zones[claim.zone] = replace(self.zones[claim.zone], host=None, until_us=0)
        return True

    def fence(self, zone: str) -> bool:
        row = self.zones.get(zone)
        if row is None:
            return False
        self.zones[zone] = replace(row, epoch=row.epoch + 1, host=None, until_us=0)
        return True

    def want(self, zone: str, host: str | None) -> bool:
        if zone not in self.zones:
            return False
        self.zones[zone] = replace(self.zones[zone], wanted_host=host)
        return True

    def assert_owned(self, claim: Claim) -> None:
        if not self.owns(claim):
            raise NotOwnerError(claim.zone)

    def take(self, person: int, token: str, seat: ClusterSeat) -> None:
        self.seats[person] = seat
        self.keys[person] = Keys(token)

    def resume(self, token: str, gateway: str, keep_us: int) -> ClusterSeat | None:
        found = [who for who, keys in self.keys.items() if token in {keys.newest, keys.used}]
        if not found:
            return None
        [person] = found
        seat = self.seats[person]
        if seat.vacated_us is not None and seat.vacated_us <= self.now_us - keep_us:
            return None
        seat = replace(seat, generation=seat.generation + 1, gateway=gateway, vacated_us=None)
        self.seats[person] = seat
        return seat

    def renewed(self, person: int, used: str, newest: str) -> None:
        self.keys[person] = Keys(newest, used)

    def confirm(self, person: int, generation: int) -> bool:
        if not self.holds(person, generation):
            return False
        self.keys[person].used = None
        return True

    def vacate(self, person: int, generation: int) -> bool:
        if not self.holds(person, generation):
            return False
        seat = self.seats[person]
        self.seats[person] = replace(seat, gateway=None, vacated_us=self.now_us)
        return True

    def reoccupy(self, person: int, generation: int, gateway: str) -> bool:
        if not self.holds(person, generation):
            return False
        seat = self.seats[person]
        self.seats[person] = replace(seat, gateway=gateway, vacated_us=None)
        return True

    def leave(self, person: int, generation: int) -> bool:
        if not self.holds(person, generation):
            return False
        del self.seats[person], self.keys[person]
        return True

    def remove_vacant(self, owner: Claim, keep_us: int) -> list[int]:
        self.assert_owned(owner)
        gone = [
            person
            for person, seat in self.seats.items()
            if seat.zone == owner.zone
            and seat.vacated_us is not None
            and seat.vacated_us <= self.now_us - keep_us
        ]
        for person in gone:
            del self.seats[person], self.keys[person]
        return sorted(gone)

    def hop(self, owner: Claim, person: int, hops: int, destination: str, state: bytes) -> bool:
        self.assert_owned(owner)
        seat = self.seats.get(person)
        if seat is None or (seat.hops, seat.zone) != (hops, owner.zone):
            return False
        self.seats[person] = replace(seat, zone=destination, hops=hops + 1, state=state)
        return True

    def holds(self, person: int, generation: int) -> bool:
        seat = self.seats.get(person)
        return seat is not None and seat.generation == generation
