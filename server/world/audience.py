"""The audience of a zone: from each frame, what every viewer of this server is to be told."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from esplanade.protocol.snapshot import RECORD
from esplanade.protocol.steps import STEP
from esplanade.server.world.avatars import Avatars
from esplanade.server.world.byte_budget import byte_budget
from esplanade.server.world.compiled._snapshot_kernels import choose, gather
from esplanade.server.world.frame import Events, Frame, Line, Reshaped
from esplanade.server.world.interest import Interest
from esplanade.server.world.routes import Point
from esplanade.server.world.rules import Rules
from esplanade.server.world.stage_times import StageTimes
from esplanade.server.world.state import Slots

RECORD_BYTES = RECORD.itemsize
STEP_BYTES = STEP.itemsize
LEAVE_BYTES = 3
"""Of an id in a leave message; the few bytes around all of them are left out."""


@dataclass(frozen=True)
class Snapshots:
    """One tick's snapshots and steps of all viewers, packed one after the other.

    The viewer with id `viewers[i]` is to get the records up to `record_ends[i]`, from where the
    one before it ends, and likewise the steps.
    """

    tick: int
    places: Slots
    """The viewers' places in the tables of interest."""
    viewers: list[int]
    acks: npt.NDArray[np.int64]
    record_ends: npt.NDArray[np.int64]
    step_ends: npt.NDArray[np.int64]
    records: npt.NDArray[np.uint8]
    """(N, bytes of a record)."""
    steps: npt.NDArray[np.uint8]
    """(M, bytes of a step)."""


@dataclass(frozen=True)
class Heard:
    """A line of chat, what its speaker is called, and the ids of the viewers who hear it."""

    line: Line
    name: str
    viewers: list[int]


@dataclass(frozen=True)
class News:
    """News of a tick for its viewers, by their ids, in the order in which they are told."""

    tick: int
    doors: Mapping[str, bool]
    left: Mapping[int, list[int]]
    """Ids of avatars that went out of view or out of the world."""
    entered: Mapping[int, list[bytes]]
    """Avatars that came into view, each packed for an enter message."""
    pointing: Mapping[int, tuple[Point | None, list[int]]]
    """The new target of each actor that points, and the viewers who see it; by the actor's id."""
    reshaped: list[tuple[Reshaped, list[int]]]
    """Avatars that have another body since this tick, and who sees each."""
    gestures: Mapping[int, tuple[int, list[int]]]
    """The gesture that each avatar begins, and the viewers who see it; by the avatar's id."""
    away: Mapping[int, tuple[bool, list[int]]]
    """Whether each of these is away, and the viewers who are to be told so; by the avatar's id."""
    chat: list[Heard]
    """In the order in which people spoke."""
    snapshots: Snapshots
    events: Events
    people: int
    actors: int


class Audience:
    """The viewers of one server. It knows of the zone what frames say, and nothing else.

    Frames and calls of `wrote` in the same order give the same news, bit for bit.
    """

    def __init__(self, rules: Rules, origin_m: tuple[float, float], times: StageTimes) -> None:
        self._avatars = Avatars(origin_m)
        self._interest = Interest(self._avatars, rules)
        self._budget = byte_budget(rules)
        self._stepless: set[int] = set()
        self._times = times

    def take(self, frame: Frame) -> News:
        """Take in the next frame, and work out what each viewer is to be told."""
        with self._times.stage("interest"):
            heard = self._last_words(frame)
            left = self._come_and_go(frame)
            entered, found_away = self._look(frame, left)
            self._interest.charge(_sizes(left, entered), self._budget)
            pointed = frame.events.pointing
            spoken = [line.id for line in frame.events.chat]
            made, gone_away = frame.events.gestures, frame.events.away
            bodies = [each.id for each in frame.reshaped]
            seen = self._interest.seen_by([*pointed, *spoken, *bodies, *made, *gone_away])
            reshaped = [(each, seen[each.id]) for each in frame.reshaped]
            pointing = {actor: (target, seen[actor]) for actor, target in pointed.items()}
            gestures = {avatar: (made[avatar], seen.get(avatar, [])) for avatar in made}
            away = {one: (is_away, seen.get(one, [])) for one, is_away in gone_away.items()}
            for avatar, viewers in found_away.items():
                known = away.get(avatar, (True, []))[1]
                away[avatar] = (True, known + [one for one in viewers if one not in known])
            for k, line in enumerate(frame.events.chat):
                if line.id in self._avatars:
                    hearers = [v for v in seen[line.id] if line.to is None or v in line.to]
                    heard[k] = Heard(line, self._avatars.name(line.id), hearers)
            chat = [heard[k] for k in sorted(heard)]
        with self._times.stage("encode"):
            snapshots = self._encode(frame.tick)
        return News(
            tick=frame.tick,
            doors=frame.events.doors,
            left=left,
            entered=entered,
            pointing=pointing,
            reshaped=reshaped,
            gestures=gestures,
            away=away,
            chat=chat,
            snapshots=snapshots,
            events=frame.events,
            people=frame.people,
            actors=frame.actors,
        )

    def wrote(self, snapshots: Snapshots, places: list[int]) -> None:
        """Of the snapshots, those at these places were sent; the next ones build on them."""
        self._interest.views.written[snapshots.places[places]] = snapshots.tick

    def send_no_steps(self, avatar_id: int) -> None:
        """Send no steps to the viewer of this avatar, once the next frame attaches it."""
        self._stepless.add(avatar_id)

    # --- questions ----------------------------------------------------------------------------

    @property
    def walkers_shown(self) -> int:
        """Number of avatars whose steps are sent, counted for each viewer."""
        return self._interest.walkers_shown

    def sees(self, viewer_id: int, avatar_id: int) -> bool:
        """Whether that viewer has that avatar in view."""
        return self._interest.sees(viewer_id, avatar_id)

    def seen_by(self, avatar_id: int) -> list[int]:
        """Ids of the viewers who have that avatar in view."""
        return self._interest.seen_by([avatar_id]).get(avatar_id, [])

    def is_actor(self, avatar_id: int) -> bool:
        return self._avatars.is_actor(avatar_id)

    # --- a frame ------------------------------------------------------------------------------

    def _last_words(self, frame: Frame) -> dict[int, Heard]:
        """The lines of those who left in this tick, for whoever saw them until now; by place."""
        gone = set(frame.left)
        lines = [(k, line) for k, line in enumerate(frame.events.chat) if line.id in gone]
        seen = self._interest.seen_by([line.id for _, line in lines])
        return {
            k: Heard(line, self._avatars.name(line.id), seen[line.id])
            for k, line in lines
            if line.id in self._avatars
        }

    def _come_and_go(self, frame: Frame) -> dict[int, list[int]]:
        """Take in who is there and who looks; returns the ids that left views, by viewer."""
        interest, avatars = self._interest, self._avatars
        interest.settle()
        left = interest.drop(frame.left)
        avatars.remove(frame.left)
        for avatar_id in frame.detached:
            interest.detach(avatar_id)
            left.pop(avatar_id, None)
        avatars.add(frame.entered)
        avatars.reshape(frame.reshaped)
        avatars.update(frame)
        interest.notice(entered.id for entered in frame.entered)
        for _, avatar_id in frame.joined + frame.attached:
            interest.attach(avatar_id, steps=avatar_id not in self._stepless)
            left.pop(avatar_id, None)
        self._stepless.clear()
        if frame.acks:
            interest.acknowledge(frame.acks)
        return left

    def _look(
        self, frame: Frame, left: dict[int, list[int]]
    ) -> tuple[dict[int, list[bytes]], dict[int, list[int]]]:
        """Look again; adds to `left`, and returns the avatars that came into view, by viewer.

        And, by the ids of those among them who are away, the viewers into whose view they came.
        """
        came, went = self._interest.look(frame.tick)
        for viewer, ids in went.items():
            left.setdefault(viewer, []).extend(ids)
        rows = np.array(sorted({row for rows in came.values() for row in rows}), dtype=np.int64)
        packed = dict(zip(rows.tolist(), self._avatars.pack(rows), strict=True))
        found_away: dict[int, list[int]] = {}
        for viewer, seen in came.items():
            for avatar in self._avatars.away(seen):
                found_away.setdefault(avatar, []).append(viewer)
        entered = {viewer: [packed[row] for row in seen] for viewer, seen in came.items()}
        return entered, found_away

    def _encode(self, tick: int) -> Snapshots:
        """Snapshots for every viewer against what it has; its own avatar is always in it."""
        avatars, interest = self._avatars, self._interest
        viewers = interest.viewers()
        counts = np.empty((len(viewers), 2), dtype=np.int64)
        choose(interest.views, viewers, avatars.changes, self._budget, tick, counts)
        ends = np.ascontiguousarray(counts.cumsum(axis=0).T)
        records, steps = counts.sum(axis=0).tolist()
        record_block = np.empty((records, RECORD_BYTES), dtype=np.uint8)
        step_block = np.empty((steps, STEP_BYTES), dtype=np.uint8)
        gather(interest.views, viewers, avatars.records, avatars.steps, record_block, step_block)
        return Snapshots(
            tick=tick,
            places=viewers,
            viewers=interest.ids(viewers).tolist(),
            acks=interest.views.ack[viewers],
            record_ends=ends[0],
            step_ends=ends[1],
            records=record_block,
            steps=step_block,
        )


def _sizes(left: Mapping[int, list[int]], entered: Mapping[int, list[bytes]]) -> dict[int, int]:
    """The bytes that changes of view take, by the viewer's id."""
    sizes = {viewer: LEAVE_BYTES * len(ids) for viewer, ids in left.items()}
    for viewer, entities in entered.items():
        sizes[viewer] = sizes.get(viewer, 0) + sum(map(len, entities))
    return sizes
