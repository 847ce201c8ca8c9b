"""The state of a cluster as its database has it, for people and for programs."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, select

from esplanade.planning.scene.world_file import MOST_PEOPLE, parse_world
from esplanade.server.cluster import processes
from esplanade.server.cluster.database_time import NOW_US
from esplanade.server.cluster.ownership import ownerships
from esplanade.server.cluster.processes import GATEWAY, HOST, ClusterProcess
from esplanade.server.cluster.seats import people_by_zone
from esplanade.server.cluster.world_rows import file_of, world_kept
from esplanade.server.cluster.zone_rows import checkpoints_ago_us
from esplanade.server.zones import copies_in


@dataclass(frozen=True)
class ZoneStatus:
    """A zone, its owner, and how fresh what is known of it is."""

    zone: str
    host: str | None
    epoch: int
    lease_left_s: float | None
    """None where nobody owns it."""
    wanted_host: str | None
    seats: int
    """People who belong there, those included whose connections are lost."""
    checkpoint_age_s: float | None
    is_open: bool
    """Whether a host is to own it; a copy of a zone is not open until the others are crowded."""


@dataclass(frozen=True)
class Status:
    """The zones and the processes of a cluster, and what does not fit together."""

    world: str
    start: str
    zones: list[ZoneStatus]
    processes: list[ClusterProcess]

    @property
    def disagreements(self) -> list[str]:
        """All that does not fit together, each a sentence."""
        there = {each.name for each in self.processes if each.is_there}
        found = []
        for zone in self.zones:
            if not zone.is_open:
                continue
            if zone.lease_left_s is None or zone.lease_left_s <= 0.0:
                found.append(f"zone {zone.zone}: nobody owns it")
            elif zone.host not in there:
                found.append(f"zone {zone.zone}: its owner {zone.host} is not there")
            if zone.wanted_host is not None and zone.wanted_host not in there:
                found.append(f"zone {zone.zone}: {zone.wanted_host} is to have it and is not there")
        kinds = {each.kind for each in self.processes if each.is_there}
        if GATEWAY not in kinds:
            found.append("there is no gateway: nobody can come in")
        known = {zone.zone for zone in self.zones}
        if self.start not in known:
            found.append(f"newcomers enter {self.start}, and there is no such zone")
        return found

    def as_data(self) -> Mapping[str, Any]:
        """The same as plain data."""
        return {**asdict(self), "disagreements": self.disagreements}

    def as_text(self) -> str:
        """The same as lines for people."""
        lines = [f"{self.world}: newcomers enter {self.start}", ""]
        lines.append(f"{'zone':<16}{'owner':<24}{'lease':>7}{'seats':>7}{'saved':>8}  epoch")
        for zone in self.zones:
            owned = zone.lease_left_s is not None and zone.lease_left_s > 0.0
            owner = (zone.host or "-") if owned else ("-" if zone.is_open else "shut")
            lease = f"{zone.lease_left_s:.1f} s" if owned else "-"
            age = zone.checkpoint_age_s
            saved = "-" if age is None else f"{age:.1f} s"
            lines.append(
                f"{zone.zone:<16}{owner:<24}{lease:>7}{zone.seats:>7}{saved:>8}  {zone.epoch}"
            )
        lines += ["", f"{'process':<40}{'kind':<9}{'people':>7}{'heard':>9}"]
        for each in self.processes:
            state = " drained" if each.drained else ""
            heard = f"{each.ago_us / 1e6:.1f} s"
            lines.append(f"{each.name:<40}{each.kind:<9}{each.people:>7}{heard:>9}{state}")
        standing = [
            each.name
            for each in self.processes
            if each.kind == HOST
            and each.is_there
            and each.name not in {zone.host for zone in self.zones}
        ]
        lines += ["", f"standing by: {', '.join(standing) or 'none'}"]
        lines += [f"disagreement: {each}" for each in self.disagreements]
        return "\n".join(lines) + "\n"


def read_status(connection: Connection) -> Status:
    """Read the state of the cluster.

    Raises
    ------
    NoWorldError
        There is no world yet.
    """
    world = world_kept(connection)
    now_us = int(connection.execute(select(NOW_US)).scalar_one())
    seats, saved = people_by_zone(connection), checkpoints_ago_us(connection)
    file, _ = parse_world(Path(world.file), file_of(connection, world))
    copied = copies_in(file, MOST_PEOPLE)
    zones = [
        ZoneStatus(
            zone=each.zone,
            host=each.host,
            epoch=each.epoch,
            lease_left_s=(each.until_us - now_us) / 1e6 if each.host is not None else None,
            wanted_host=each.wanted_host,
            seats=seats.get(each.zone, 0),
            checkpoint_age_s=saved[each.zone] / 1e6 if each.zone in saved else None,
            is_open=each.zone not in copied or each.zone in copied[each.zone].wanted(seats),
        )
        for each in ownerships(connection)
    ]
    return Status(world.name, world.start, zones, processes.processes(connection))
