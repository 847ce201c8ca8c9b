"""Files of episodes: where the robot and the people around it were, tick by tick."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from esplanade.commandline.provenance import software
from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.people import People
from esplanade.evaluation.replay import Floats, Replay
from esplanade.evaluation.trials import Trial
from esplanade.recordings.jupedsim_tables import box
from esplanade.recordings.samples import SAMPLE, Head, Note, Samples
from esplanade.recordings.streams import open_stream


@dataclass(frozen=True)
class EpisodeFiles:
    """The files that episodes are written into, one for each: `walks-zara1-straight-003.csv`."""

    pattern: Path
    """A file; recording, policy and number are put into its name."""
    names: Mapping[Path, str]
    """Names of recordings by their path."""
    command: str

    def path(self, trial: Trial, episode: Episode) -> Path:
        """The file of an episode."""
        name = self.names[trial.source.path].replace("/", "_")
        return self.pattern.with_stem(
            f"{self.pattern.stem}-{name}-{trial.label}-{episode.number:03d}"
        )

    def write(self, trial: Trial, episode: Episode, walked: Floats, people: People) -> None:
        """Write an episode in which the robot was at `walked`, (T + 1, 2), metres.

        `people` are those of the episode, who may have left their recorded places.

        Raises
        ------
        WritingError
            The file cannot be written.
        """
        replay = trial.source.environment(trial.rules.tick_s).replay
        x0, y0, x1, y1 = replay.bounds
        bounds = (x0 - 1.0, y0 - 1.0, x1 + 1.0, y1 + 1.0)
        told = self._provenance(trial, episode, replay)
        stream = open_stream(
            self.path(trial, episode), Head(told, 1.0 / replay.tick_s, bounds, box(bounds))
        )
        try:
            first = episode.first_tick
            robot = {"id": robot_id(replay), "radius_m": trial.rules.robot_radius_m}
            stream.note(_note(first, "avatar", {**robot, "kind": "actor"}))
            present = replay.present_between(first, first + len(walked) - 1).tolist()
            for number in present:
                if number != episode.pedestrian:
                    person = {"id": number + 1, "radius_m": trial.rules.person_radius_m}
                    recorded = {"kind": "person", "recorded": replay.ids[number]}
                    stream.note(_note(first, "avatar", person | recorded))
            for n in range(len(walked)):
                stream.add(_samples(replay, episode, walked, people, n))
            stream.note(_note(first + len(walked) - 1, "end", {}))
        finally:
            stream.close()

    def _provenance(self, trial: Trial, episode: Episode, replay: Replay) -> dict[str, str]:
        source = trial.source
        told = {**software(), "command": self.command, "recording": source.path.name}
        told["recording sha256"] = source.digest()
        told["policy"], told["settings"] = trial.policy, json.dumps(dict(trial.settings))
        told["rules"] = json.dumps(asdict(trial.rules))
        told["episode"] = f"{episode.number}, in place of {replay.ids[episode.pedestrian]}"
        told["time"] = f"seconds of the recording; frame k is at k x {replay.tick_s:g} s"
        return told


def robot_id(replay: Replay) -> int:
    """The robot's number: people have those from 1 on, in the order of the replay."""
    return len(replay.ids) + 1


def _samples(replay: Replay, episode: Episode, walked: Floats, people: People, n: int) -> Samples:
    """Everybody at the n-th tick of an episode; velocities are those that led there."""
    tick = episode.first_tick + n
    present = people.present(tick)
    present = present[present != episode.pedestrian]
    before = np.array(
        [people.at(int(j), max(tick - 1, int(people.first[j]))) for j in present]
    ).reshape(-1, 2)
    places = np.vstack([people.positions(present, tick), walked[n]])
    velocities = (places - np.vstack([before, walked[max(n - 1, 0)]])) / replay.tick_s
    found = np.zeros(len(places), dtype=SAMPLE)
    found["frame"], found["t"] = tick, tick * replay.tick_s
    found["id"] = [*(present + 1).tolist(), robot_id(replay)]
    found["actor"][-1] = True
    found["x"], found["y"] = places.T
    found["vx"], found["vy"] = velocities.T
    found["heading"] = np.arctan2(velocities[:, 1], velocities[:, 0])
    return found


def _note(tick: int, kind: str, told: Mapping[str, object]) -> Note:
    return Note(tick, tick, kind, json.dumps(told))
