"""A world of several scenes that is checked: what each zone holds, and what is wrong with it."""

from dataclasses import dataclass
from typing import Any

from rich.console import Console
from rich.table import Table

from esplanade.planning import LayeredGrid
from esplanade.planning.routes.portal_reach import unreached_portals
from esplanade.planning.scene.world_file import World
from esplanade.scenery.inventory import Inventory, take_inventory


@dataclass(frozen=True)
class CheckedZone:
    """A zone with what its scene holds, and the portals that nobody gets to."""

    name: str
    inventory: Inventory
    exits: dict[str, str]
    """The zone that each portal leads to, by the portal's name."""
    unreached: tuple[str, ...]

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
        }


def check_zones(world: World, cell_m: float) -> list[CheckedZone]:
    """Each zone of a world with what its scene holds, with all doors open."""
    return [_checked(world, name, cell_m) for name in world.scenes]


def _checked(world: World, name: str, cell_m: float) -> CheckedZone:
    scene = world.scenes[name]
    opened = tuple(door.model_copy(update={"open": True}) for door in scene.doors)
    scene = scene.model_copy(update={"doors": opened})
    grid = LayeredGrid.from_scene(scene, cell_m)
    return CheckedZone(
        name,
        take_inventory(scene, cell_m),
        {portal: zone for portal, (zone, _) in world.exits(name).items()},
        tuple(unreached_portals(grid, scene, world.arrivals(name))),
    )


def show(shown: Console, world: World, zones: list[CheckedZone]) -> None:
    """Print a table of the zones, with where their portals lead."""
    shown.print(f"[bold]{world.file.name}[/bold]  newcomers enter {world.file.start_zone}\n")
    table = Table("zone", "scene", "cells", "exits", box=None, pad_edge=False)
    for zone in zones:
        exits = ", ".join(f"{portal} → {to}" for portal, to in zone.exits.items()) or "none"
        found = zone.inventory
        table.add_row(zone.name, found.name, str(found.cells), exits)
    shown.print(table)
