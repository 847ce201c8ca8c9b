"""Recordings of our own in the forms that others write: people of a world of ours, and of JuPedSim.

A recorded crowd is read from what `esplanade run` writes. JuPedSim's own writer writes its run.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from esplanade.cli import main
from esplanade.planning import Scene
from esplanade.recordings import Crowd, read_crowd

PIXEL_M = 0.05
_PEOPLE = "22"
_SQUARE = (0.0, 0.0, 18.0, 12.0)


class Sample(NamedTuple):
    """A place of somebody: number of the sample, number of the person, metres, metres a second."""

    number: int
    person: int
    x: float
    y: float
    vx: float
    vy: float


def walk(folder: Path) -> Crowd:
    """People who walk about on a square of 18 m x 12 m for 40 s, at 2.5 samples a second."""
    return _recorded(folder / "square.csv", Scene.open_space(_SQUARE, name="square"), 2.5)


def passage(folder: Path) -> Crowd:
    """People who go through an opening of 1.6 m between two halls, at 10 samples a second."""
    walls = [{"start": a, "end": b} for a, b in (((9, 0), (9, 4.2)), ((9, 5.8), (9, 10)))]
    scene = Scene.model_validate({"name": "passage", "bounds": (0, 0, 18, 10), "walls": walls})
    return _recorded(folder / "passage.csv", scene, 10.0)


def _recorded(path: Path, scene: Scene, hz: float) -> Crowd:
    file = path.with_suffix(".json")
    file.write_text(scene.model_dump_json())
    words = ["run", str(file), "--actors", _PEOPLE, "--seconds", "40", "--seed", "3"]
    if main([*words, "--hz", str(hz), "--out", str(path)]):
        raise SystemExit("esplanade run: failed")
    return read_crowd(path)


def samples(crowd: Crowd) -> list[Sample]:
    """All samples by time."""
    found = [sample for number, _ in enumerate(crowd.tracks) for sample in _of(crowd, number)]
    return sorted(found)


def _of(crowd: Crowd, number: int) -> Iterator[Sample]:
    track = crowd.tracks[number]
    if len(track.times) < 2:
        return
    speeds = np.gradient(track.positions, track.times, axis=0)
    step_s = float(np.median(np.diff(track.times)))
    for time_s, place, speed in zip(track.times, track.positions, speeds, strict=True):
        yield Sample(round(time_s / step_s), number + 1, *place.tolist(), *speed.tolist())


def obsmat(path: Path, crowd: Crowd) -> Path:
    """ETH's eight columns, every tenth frame of 25 a second."""
    rows = [
        f"{10 * n:.7e} {who:.7e} {x:.7e} 0 {y:.7e} {vx:.7e} 0 {vy:.7e}\n"
        for n, who, x, y, vx, vy in samples(crowd)
    ]
    path.write_text("".join(rows))
    return path


def four_columns(path: Path, crowd: Crowd) -> Path:
    """The text of TrajNet and Social-GAN."""
    rows = [f"{10.0 * n}\t{float(who)}\t{x:.2f}\t{y:.2f}\n" for n, who, x, y, *_ in samples(crowd)]
    path.write_text("".join(rows))
    return path


def trajnet(path: Path, crowd: Crowd) -> Path:
    """The lines of JSON of TrajNet++."""
    tracks = [
        json.dumps({"track": {"f": 10 * n, "p": who, "x": round(x, 2), "y": round(y, 2)}})
        for n, who, x, y, *_ in samples(crowd)
    ]
    scene = json.dumps({"scene": {"id": 0, "p": 1, "s": 0, "e": 1000, "fps": 2.5}})
    path.write_text("\n".join([scene, *tracks, ""]))
    return path


def splines(path: Path, crowd: Crowd) -> Path:
    """UCY's control points in pixels of 5 cm, at 25 frames a second."""
    lines = [f"{len(crowd.tracks)} - the number of splines"]
    for number, track in enumerate(crowd.tracks):
        lines.append(f"{len(track.times)} - Num of control points")
        lines += [
            f"{x / PIXEL_M:.3f} {y / PIXEL_M:.3f} {10 * n} 0.0 - (2D point, m_id)"
            for n, _, x, y, *_ in _of(crowd, number)
        ]
    path.write_text("\n".join([*lines, ""]))
    return path


def juelich(path: Path, crowd: Crowd) -> Path:
    """The text of PeTrack in centimetres, as experiments of Jülich are archived."""
    rows = [f"{who} {n} {100 * x:.3f} {100 * y:.3f} 174.0\n" for n, who, x, y, *_ in samples(crowd)]
    path.write_text("".join(["# framerate: 10 fps\n", "# id frame x/cm y/cm z/cm\n", *rows]))
    return path


def jupedsim(path: Path) -> Path:
    """A run of JuPedSim: thirty people leave a hall through a door of 1.2 m."""
    import jupedsim as jps  # noqa: PLC0415 - of the extra `evaluate`
    import shapely  # noqa: PLC0415

    hall = shapely.union_all(
        [shapely.box(0, 0, 10, 9), shapely.box(9.9, 3.9, 11.1, 5.1), shapely.box(11, 0, 18, 9)]
    )
    model: Any = jps.CollisionFreeSpeedModel()
    writer = jps.SqliteTrajectoryWriter(output_file=path, every_nth_frame=10)
    simulation = jps.Simulation(model=model, geometry=hall, trajectory_writer=writer, dt=0.01)
    out = simulation.add_exit_stage([(17.0, 1.0), (18.0, 1.0), (18.0, 8.0), (17.0, 8.0)])
    journey = simulation.add_journey(jps.JourneyDescription([out]))
    for place in jps.distribute_by_number(
        polygon=shapely.box(1, 1, 9, 8),
        number_of_agents=30,
        distance_to_agents=0.6,
        distance_to_polygon=0.4,
        seed=1,
    ):
        simulation.add_agent(
            jps.CollisionFreeSpeedModelAgentParameters(
                position=place, journey_id=journey, stage_id=out
            )
        )
    while simulation.agent_count() and simulation.iteration_count() < 6000:
        simulation.iterate()
    return path
