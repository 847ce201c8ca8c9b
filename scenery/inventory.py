"""The inventory of a scene: extent, layers, cells, memory, and what each body reaches."""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np
from rich.console import Console
from rich.table import Table

from esplanade.planning import LayeredGrid, Scene
from esplanade.scenery.bodies import PRESETS
from esplanade.scenery.reach import Reach, reach_of

_PARTS: Final = ("polygons", "walls", "stairs", "doors", "spawns", "places", "portals")


@dataclass(frozen=True)
class Layer:
    """The cells and heights of one layer."""

    cells: int
    area_m2: float
    lowest_m: float
    highest_m: float


@dataclass(frozen=True)
class Inventory:
    """The counts and measures of a scene."""

    name: str
    extent_m: tuple[float, float, float]
    """The extent from west to east, from south to north, and from the lowest to the highest
    floor."""
    cell_m: float
    layers: tuple[Layer, ...]
    memory_bytes: int
    """The memory of the layered cells and their links."""
    parts: Mapping[str, int]
    reach: Mapping[str, Reach]
    """The places that each body reaches, by the name of the body."""

    @property
    def cells(self) -> int:
        """The number of cells with a floor in all layers."""
        return sum(layer.cells for layer in self.layers)

    @property
    def unreached(self) -> tuple[str, ...]:
        """The places that no body reaches."""
        return _common(reach.places_missed for reach in self.reach.values())

    @property
    def faults(self) -> tuple[str, ...]:
        """Messages about faults that make a well-formed scene useless."""
        blocked = _common(reach.spawns_blocked for reach in self.reach.values())
        return (
            *(() if self.cells else ("there is no floor to stand on",)),
            *(f"{spawn}: nobody can stand there" for spawn in blocked),
            *(f"place {place!r}: nobody gets there from the spawns" for place in self.unreached),
        )

    def figures(self) -> dict[str, Any]:
        """All counts and measures, ready for JSON."""
        return {**asdict(self), "cells": self.cells, "faults": list(self.faults)}


def take_inventory(scene: Scene, cell_m: float) -> Inventory:
    """Take the inventory of a scene with all doors open, so that rooms behind them count."""
    opened = tuple(door.model_copy(update={"open": True}) for door in scene.doors)
    scene = scene.model_copy(update={"doors": opened})
    grid = LayeredGrid.from_scene(scene, cell_m)
    surfaces = grid.surfaces
    layers = []
    for number in range(surfaces.layer_count):
        floors = surfaces.floors[surfaces.layers == number]
        if len(floors):
            area_m2 = len(floors) * cell_m**2
            layers.append(Layer(len(floors), area_m2, float(floors.min()), float(floors.max())))
    x0, y0, x1, y1 = scene.bounds
    low, high = (float(surfaces.floors.min()), float(surfaces.floors.max())) if layers else (0, 0)
    return Inventory(
        scene.name,
        (x1 - x0, y1 - y0, high - low),
        cell_m,
        tuple(layers),
        sum(part.nbytes for part in grid.layered if isinstance(part, np.ndarray)),
        {part: len(getattr(scene, part)) for part in _PARTS},
        {name: reach_of(grid, scene, preset()) for name, preset in PRESETS.items()},
    )


def show(console: Console, found: Inventory) -> None:
    """Print the inventory as text and a table."""
    width, depth, height = found.extent_m
    parts = ", ".join(f"{count} {part}" for part, count in found.parts.items() if count)
    console.print(f"[bold]{found.name}[/bold]  {width:g} m × {depth:g} m, floors over {height:g} m")
    console.print(f"{parts}\n", highlight=False)
    table = Table("layer", *(("cells", "area m²", "floors m")), box=None, pad_edge=False)
    for number, layer in enumerate(found.layers):
        heights = f"{layer.lowest_m:.2f} to {layer.highest_m:.2f}"
        table.add_row(str(number), str(layer.cells), f"{layer.area_m2:.0f}", heights)
    console.print(table)
    console.print(
        f"{found.cells} cells of {found.cell_m:g} m, {found.memory_bytes / 2**20:.1f} MiB\n"
    )
    for name, reach in found.reach.items():
        missed = ", but not " + ", ".join(reach.places_missed) if reach.places_missed else ""
        console.print(
            f"{name:<6} can stand in {reach.standing:.1%} of it, and comes from the spawns to "
            f"{reach.reached:.1%} of that{missed}",
            soft_wrap=True,
        )
    for name, reach in found.reach.items():
        for place, how in reach.places_moved.items():
            console.print(f"place {place!r} of {name}: {how}", soft_wrap=True, highlight=False)


def _common(groups: Iterable[tuple[str, ...]]) -> tuple[str, ...]:
    """The items that all groups contain, in the order of the first group."""
    first, *others = groups
    return tuple(name for name in first if all(name in other for other in others))
