"""Shows what one viewer in the midst of a crowd is told of the others, within its budget of bytes.

    python -m benchmarks.viewer                                    1000 people on 100 m x 100 m
    python -m benchmarks.viewer --people 2000 --budgets 6000 12000
    python -m benchmarks.viewer --picture docs/images/viewer-budget.svg

A world without sockets runs, in which 70 % of the people walk and change their mind every two
seconds; one of them looks. Printed is, for each budget, what that one is sent in a second, of how
many walkers it gets all steps, and how old the newest record of the others is.
"""

import argparse
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
from benchmarks._stages import steering
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table

from esplanade.actors import Population
from esplanade.planning import LayeredGrid, Scene
from esplanade.protocol.snapshot import RECORD
from esplanade.protocol.steps import STEP, StepRecords
from esplanade.server.loading import load_scene
from esplanade.server.settings import ServerSettings
from esplanade.server.world.audience import Audience, News
from esplanade.server.world.inputs import Detach, Join, Steer
from esplanade.server.world.zone import Zone

TICK_S: Final = 0.05
SETTLING_TICKS: Final = 400
"""Steps find their reach within this time."""
MEASURED_TICKS: Final = 200
BUDGETS: Final = (6_000, 12_000, 24_000, 1_000_000)


@dataclass
class Told:
    """The news that a viewer was sent in the measured time."""

    bytes: int = 0
    in_view: list[int] = field(default_factory=list)
    steps_due: dict[int, int] = field(default_factory=dict)
    """Steps that everyone began, by id."""
    steps: dict[int, int] = field(default_factory=dict)
    """Steps that the viewer was sent, by the walker's id."""
    heard_at: dict[int, int] = field(default_factory=dict)
    ages_s: list[float] = field(default_factory=list)
    """Ages of the newest news of everyone in view, at every tick."""
    places: dict[int, tuple[float, float]] = field(default_factory=dict)

    @property
    def planted(self) -> set[int]:
        """Walkers of whom nearly all steps came."""
        return {
            who for who, count in self.steps.items() if count >= 0.8 * self.steps_due.get(who, 0)
        }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--people", type=int, default=1000)
    parser.add_argument("--side", type=float, default=100.0, help="of the square, metres [100]")
    parser.add_argument("--budgets", type=int, nargs="+", default=BUDGETS, help="bytes a second")
    parser.add_argument("--picture", type=Path, help="draw the first 12000 bytes/s into this file")
    options = parser.parse_args()
    table = Table(title=f"{options.people} people on {options.side:g} m x {options.side:g} m")
    for name in ("budget, B/s", "sent, B/s", "in view", "walkers by steps", "news p50, s", "p99"):
        table.add_column(name, justify="right")
    for budget in options.budgets:
        told = watch(options.people, options.side, budget)
        middle, most = np.percentile(told.ages_s, (50, 99))
        table.add_row(
            str(budget),
            f"{told.bytes / MEASURED_TICKS / TICK_S:.0f}",
            f"{np.mean(told.in_view):.0f}",
            str(len(told.planted)),
            f"{middle:.2f}",
            f"{most:.2f}",
        )
        if options.picture and budget == 12_000:
            draw(told, options.picture)
    Console().print(table)


def watch(people: int, side_m: float, budget: int) -> Told:
    """Run the world, and keep what the first person is sent."""
    scene = Scene.open_space((0.0, 0.0, side_m, side_m))
    rules = load_scene(ServerSettings(viewer_bytes=budget)).rules
    grid = LayeredGrid.from_scene(scene)
    zone = Zone(
        scene,
        grid,
        Population(grid, scene, tick_s=TICK_S, person_radius_m=rules.person_radius_m),
        {},
        rules,
        tick_s=TICK_S,
        max_people=people,
        seed=3,
        clock=float,
    )
    audience = Audience(zone.rules, zone.origin_m, zone.times)
    zone.begin([Join(k, "p", None) for k in range(people)])
    frame = zone.finish(zone.think())
    audience.take(frame)
    ids = [one for _, one in frame.joined]
    middle = np.array([side_m, side_m]) / 2.0
    slots = np.array([zone.state.slot(one) for one in ids])
    viewer = ids[int(np.hypot(*(zone.state.positions[slots] - middle).T).argmin())]
    zone.begin([Detach(one) for one in ids if one != viewer])
    audience.take(zone.finish(zone.think()))
    told = Told()
    wishes = steering([one for one in ids if one != viewer], TICK_S)
    for tick, news in enumerate(run(zone, audience, wishes)):
        note(told, zone, audience, news, viewer, measured=tick >= SETTLING_TICKS)
    return told


def run(zone: Zone, audience: Audience, wishes: Iterator[list[Steer]]) -> Iterator[News]:
    for _ in range(SETTLING_TICKS + MEASURED_TICKS):
        zone.begin(next(wishes))
        news = audience.take(zone.finish(zone.think()))
        audience.wrote(news.snapshots, [0])
        yield news


def note(
    told: Told, zone: Zone, audience: Audience, news: News, viewer: int, *, measured: bool
) -> None:
    """Keep what is in the news of one tick for the viewer."""
    records = news.snapshots.records.view(RECORD)[:, 0]
    steps: StepRecords = news.snapshots.steps.view(STEP)[:, 0]
    told.heard_at |= dict.fromkeys(records["id"].tolist(), news.tick)
    for who, over in zip(
        steps["id"].tolist(), (steps["tick"] + steps["ticks"]).tolist(), strict=True
    ):
        told.heard_at[who] = max(told.heard_at.get(who, 0), over)
    if not measured:
        return
    told.bytes += records.nbytes + steps.nbytes
    live = zone.state.live()
    seen = [one for one in zone.state.ids[live].tolist() if audience.sees(viewer, one)]
    told.in_view.append(len(seen) - 1)
    begun = zone.steps.begun_in(news.tick, live)["id"].tolist()
    for who in begun:
        told.steps_due[who] = told.steps_due.get(who, 0) + 1
    for who in steps["id"].tolist():
        told.steps[who] = told.steps.get(who, 0) + 1
    for who in seen:
        slot = zone.state.slot(who)
        told.places[who] = tuple(zone.state.positions[slot].tolist())
        if zone.state.speeds[slot] > 0.0 and who != viewer:
            told.ages_s.append(TICK_S * max(0, news.tick - told.heard_at.get(who, news.tick)))
    told.places = {who: told.places[who] for who in seen}


def draw(told: Told, file: Path) -> None:
    """Draw everyone in view from above, and how the viewer is told of them."""
    figure = Figure(figsize=(6.4, 6.4), layout="constrained")
    axes = figure.subplots()
    planted = told.planted
    kinds = (
        ("walks by steps", "#c0392b", planted),
        ("some steps came", "#e59866", told.steps.keys() - planted),
        ("walks by the common gait, or stands", "#85929e", told.places.keys() - told.steps.keys()),
    )
    for name, colour, ids in kinds:
        places = np.array([told.places[who] for who in sorted(ids) if who in told.places])
        axes.scatter(*places.reshape(-1, 2).T, s=36, color=colour, label=f"{len(places)}: {name}")
    axes.set_aspect("equal")
    axes.set_xlabel("m")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08), frameon=False)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, metadata={"Date": None} if file.suffix == ".svg" else None)


if __name__ == "__main__":
    main()
