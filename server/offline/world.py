"""A world without a server: the same zone, its actors and recorded people, tick by tick."""

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

import numpy as np
from numpy.typing import NDArray

from esplanade.commandline.recording_settings import READING
from esplanade.recordings import Crowd
from esplanade.recordings.samples import Note
from esplanade.recordings.streams import Stream, open_stream
from esplanade.recordings.writing import WritingError
from esplanade.server.building import build_world
from esplanade.server.loading import DEFAULT_SCENE, load_scene, read_recording, rules_for
from esplanade.server.offline.recorded_people import RecordedPeople
from esplanade.server.offline.settings import OfflineSettings
from esplanade.server.trajectories.blocks import write_block
from esplanade.server.trajectories.provenance import Origin, files_of
from esplanade.server.trajectories.recorder import Recorder
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import (
    ActorCommand,
    Input,
    MoveDoor,
    PlanEvery,
    SetParameters,
)

FLUSH_TICKS: Final = 200
"""Written rows are handed over to the system after so many ticks."""


class OfflineWorld:
    """A world that goes on by `step`, as fast as the machine can.

    The same scene, people, seed and calls make the same world and the same files, bit for bit.
    """

    def __init__(
        self,
        scene: str | Path | None = None,
        *,
        people: str | Path | None = None,
        actors: int = 10,
        seed: int = 0,
        command: str = "",
        **settings: Any,
    ) -> None:
        """`scene` is a scene file; without one the ground is fitted to the people, a recording.

        `settings` are others of `esplanade serve` on world and people, such as `roster`,
        `tick_rate`, `fps`, `columns` or `person_radius_m`.

        Raises
        ------
        LoadingError
            A file cannot be read, or the scene has no room for the actors.
        """
        given: dict[str, Any] = {**settings, "seed": seed}
        if "roster" not in settings:
            given["actors"] = actors
        if people is not None and scene is None:
            given["crowd"] = Path(people)
            loaded = load_scene(OfflineSettings(**given))
        else:
            reading = {name: given.pop(name) for name in READING if name in given}
            given["scene"] = Path(scene or DEFAULT_SCENE)
            loaded = load_scene(OfflineSettings(**given))
            if people is not None:
                walking = read_recording(Path(people), reading)
                loaded = replace(loaded, rules=rules_for(loaded.rules, walking), crowd=walking)
        crowd = loaded.crowd
        given["max_clients"] = 1 if crowd is None else _room_for(crowd)
        self.settings = OfflineSettings(**given)
        self._population, self.zone, _ = build_world(loaded, self.settings)
        """The zone, whose state is read between two steps."""
        self.people = None if crowd is None else RecordedPeople(crowd, self.zone.tick_s)
        self.report = None if crowd is None else crowd.report
        """The remarks of the reader on the recording."""
        self._origin = Origin(
            command or "from Python",
            self.settings,
            files_of(self.settings, self.settings.scene, loaded.scene.mesh)
            | ({} if people is None else {"recording": Path(people)}),
        )
        interval = self.settings.planning_interval
        self._inputs: list[Input] = [] if interval is None else [PlanEvery(interval)]
        self._command = 0
        self._recorder: Recorder | None = None
        self._stream: Stream | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    @property
    def time_s(self) -> float:
        """The time of the world, seconds."""
        return self.zone.tick * self.zone.tick_s

    @property
    def positions(self) -> dict[int, tuple[float, float, float]]:
        """Where everybody is, by the id of the avatar: x, y and the height of the feet, metres."""
        state = self.zone.state
        live = state.live()
        places: NDArray[np.float64] = np.column_stack([state.positions[live], state.heights[live]])
        ids = state.ids[live].tolist()
        return {i: (x, y, z) for i, (x, y, z) in zip(ids, places.tolist(), strict=True)}

    def write(self, path: str | Path, hz: float | None = None) -> None:
        """Write everybody's trajectories from the next tick on, until `close`.

        The name ends in .csv, .txt, .sqlite or .parquet; `hz` are samples a second, all ticks
        without it.

        Raises
        ------
        WritingError
            The file cannot be written, or its format is unknown.
        ValueError
            Samples at this rate would lie between ticks.
        """
        recorder = Recorder(self.zone, hz)
        if self.people is not None:
            recorder.named = self.people.names
        self._end_file()
        self._stream = open_stream(Path(path), recorder.head(self._origin))
        self._recorder = recorder

    def step(self, inputs: Iterable[Input] = ()) -> Frame:
        """Let the world go on by a tick, with these inputs of it; returns what is told of it.

        Raises
        ------
        WritingError
            The file of trajectories cannot be written any more and ends; the world has gone on.
        """
        zone = self.zone
        given = [*self._inputs, *inputs]
        self._inputs = []
        if self.people is not None:
            given += self.people.inputs(zone.tick + 1, zone.state)
        zone.begin(given)
        frame = zone.finish(zone.think())
        if self.people is not None:
            self.people.take(frame, zone.state)
        if self._recorder is not None and self._stream is not None:
            block = self._recorder.take(frame, given)
            try:
                if block is not None:
                    write_block(self._stream, block)
                if frame.tick % FLUSH_TICKS == 0:
                    self._stream.flush()
            except WritingError:
                self._drop_file()
                raise
        return frame

    def set_parameters(self, *actors: str, **values: float) -> None:
        """Give actors, or all of them, other parameters from the next tick on.

        Raises
        ------
        ValueError
            There is no such actor or parameter, or a value is out of range.
        """
        self._command += 1
        chosen = actors or tuple(str(actor) for actor in self.zone.actors)
        self.command(SetParameters(self._command, chosen, values))

    def command(self, command: ActorCommand) -> None:
        """Let a command on actors be an input of the next tick.

        Raises
        ------
        ValueError
            It would be refused.
        """
        fault = self.zone.check(command)
        if fault is not None:
            raise ValueError(fault.text)
        self._inputs.append(command)

    def move_door(self, name: str, *, is_open: bool) -> None:
        """Open or close a door, once nobody stands in its way."""
        self._inputs.append(MoveDoor(name, is_open))

    def close(self) -> None:
        """Complete the file that is being written, and end the world.

        Raises
        ------
        WritingError
            The file cannot be completed; the world has ended.
        """
        try:
            self._end_file()
        finally:
            self._population.close()

    def _end_file(self) -> None:
        if self._stream is None or self._recorder is None:
            return
        try:
            self._stream.note(Note(self._recorder.last_frame, self.zone.tick, "end", "{}"))
            self._stream.close()
        except WritingError:
            self._drop_file()
            raise
        self._stream = self._recorder = None

    def _drop_file(self) -> None:
        """Leave a file as far as it came: there is nothing more to be written into it."""
        stream, self._stream, self._recorder = self._stream, None, None
        if stream is not None:
            with suppress(WritingError):
                stream.close()


def _room_for(crowd: Crowd) -> int:
    """Seats for the most people at once, and for those who leave in the same tick."""
    return min(4000, 2 * crowd.max_present + 8)
