"""A world of several scenes that is checked: what each zone holds, and what is wrong with it."""

from dataclasses import dataclass
from typing import Any

from rich.console import Console
from rich.table import Table

from esplanade.planning import LayeredGrid
from esplanade.planning.routes.portal_reach import unreached_portals
from esplanade.planning.scene.world_file import World, ZoneEntry
from esplanade.scenery.inventory import Inventory, take_inventory


@dataclass(frozen=True)
class CheckedZone:
    """A zone with what its scene holds, and the portals that nobody gets to."""

    name: str
    inventory: Inventory
    exits: dict[str, str]
    """The zone that each portal leads to, by the portal's name."""
    unreached: tuple[str, ...]
    copies: tuple[str, ...] = ()
    """The names of its copies, itself the first; empty where there are none."""

    @property
    def faults(self) -> tuple[str, ...]:
        """Messages about faults, each with the name of the zone."""
        unreached = (f"portal {name!r}: nobody gets there" for name in self.unreached)
        return tuple(
            f"zone {self.name!r}: {fault}" for fault in (*self.inventory.faults, *unreached)
        )

    def figures(self) -> dict[str, Any]:
        """All counts and measures, ready for JSON."""
        return {
            **self.inventory.figures(),
            "exits": self.exits,
            "portals_unreached": list(self.unreached),
            "copies": list(self.copies),
        }


def check_zones(world: World, cell_m: float) -> list[CheckedZone]:
    """Each zone of a world with what its scene holds, with all doors open."""
    return [_checked(world, zone, cell_m) for zone in world.file.zones]


def _checked(world: World, zone: ZoneEntry, cell_m: float) -> CheckedZone:
    name = zone.name
    scene = world.scenes[name]
    opened = tuple(door.model_copy(update={"open": True}) for door in scene.doors)
    scene = scene.model_copy(update={"doors": opened})
    grid = LayeredGrid.from_scene(scene, cell_m)
    return CheckedZone(
        name,
        take_inventory(scene, cell_m),
        {portal: to for portal, (to, _) in world.exits(name).items()},
        tuple(unreached_portals(grid, scene, world.arrivals(name))),
        zone.copy_names if zone.copies > 1 else (),
    )


def show(shown: Console, world: World, zones: list[CheckedZone]) -> None:
    """Print a table of the zones, with where their portals lead."""
    shown.print(f"[bold]{world.file.name}[/bold]  newcomers enter {world.file.start_zone}\n")
    copied = any(zone.copies for zone in zones)
    more = ("copies",) if copied else ()
    table = Table("zone", "scene", "cells", "exits", *more, box=None, pad_edge=False)
    for zone in zones:
        exits = ", ".join(f"{portal} → {to}" for portal, to in zone.exits.items()) or "none"
        found = zone.inventory
        row = [zone.name, found.name, str(found.cells), exits]
        table.add_row(*row, *([", ".join(zone.copies) or "none"] if copied else []))
    shown.print(table)
