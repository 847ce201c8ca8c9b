"""Walkers without a world: bodies that are told where to go, and what a client draws of them."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.body.traits import traits_of
from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S, Course
from esplanade.actors.locomotion.footsteps.ground import Ground
from esplanade.actors.locomotion.footsteps.walkers import Walkers
from esplanade.actors.locomotion.motion.key_poses import Steps, no_steps
from esplanade.actors.locomotion.reference.posing import Pose, pose
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.compiled.arrays import Floats
from esplanade.protocol.steps import StepRecords
from esplanade.server.world.step_records import from_records, to_records
from tests.naive.footsteps.ground import Ground as NaiveGround
from tests.naive.footsteps.walkers import Walkers as NaiveWalkers

TICK_S = 0.05
FIELD = Scene.open_space((-40.0, -40.0, 40.0, 40.0))

Slots = NDArray[np.int64]


@dataclass(frozen=True)
class Begun:
    """Steps that began in one tick, as everyone gets them."""

    tick: int
    slots: Slots
    steps: Steps
    records: StepRecords
    """The same as they are sent."""


@dataclass(frozen=True)
class Frame:
    """Everything that is drawn of everyone at one moment; `tick` may be a fraction."""

    tick: float
    steps: Steps
    share: Floats
    pose: Pose
    bodies: Floats
    """(N, 3): where the bodies are."""
    slide_m: Floats
    """(N, 2): distances of the ends that feet stand on from where these were put, left and right;
    nan for feet in the air."""


class Parade:
    """N bodies that go as they are told, and their walkers, or the plain twins of these."""

    def __init__(
        self, count: int, scene: Scene = FIELD, seed: int = 0, *, naive: bool = False
    ) -> None:
        self.count = count
        self.tick = 0
        grid = LayeredGrid.from_scene(scene)
        self.ground = Ground(scene, grid)
        self.positions = np.zeros((count, 3))
        self.headings = np.zeros(count)
        self.walkers: Walkers | NaiveWalkers = Walkers(count, self.ground, TICK_S, self._publish)
        if naive:
            self.walkers = NaiveWalkers(count, NaiveGround(scene, grid), TICK_S, self._publish)
        self.begun: list[Begun] = []
        self.places: list[Floats] = []
        self._traits = [traits_of(seed, number) for number in range(count)]
        self.sizes = BodySizes(
            np.array([sizes.leg_m for sizes in self._traits]),
            np.array([sizes.stature_m for sizes in self._traits]),
        )

    def stand(self) -> None:
        """Everyone comes in."""
        slots = np.arange(self.count)
        self.walkers.join(self.tick, slots, self._traits, self._course(None))
        self.places.append(self.positions.copy())

    def go(self, velocity: Floats | tuple[float, float], ticks: int = 1, turn: bool = True) -> None:
        """Let everyone go on at velocities (N, 2), or one for all, which change at once."""
        for _ in range(ticks):
            velocities = np.broadcast_to(np.asarray(velocity, dtype=np.float64), (self.count, 2))
            self.positions[:, :2] += velocities * TICK_S
            moving = np.hypot(velocities[:, 0], velocities[:, 1]) > 0.0
            if turn:
                ways = np.arctan2(velocities[:, 1], velocities[:, 0])
                self.headings = np.where(moving, ways, self.headings)
            self.update(self._course(velocities))

    def follow(self, places: Floats) -> None:
        """Let bodies be at places (N, T, 3), one for each tick; their paths ahead are known."""
        last = places.shape[1] - 1
        steps = np.rint(np.arange(AHEAD) * AHEAD_S / TICK_S).astype(np.int64)
        for now in range(last + 1):
            self.positions = places[:, now].copy()
            moved = places[:, min(now + 1, last)] - places[:, now]
            moving = np.hypot(moved[:, 0], moved[:, 1]) > 1e-6
            ways = np.arctan2(moved[:, 1], moved[:, 0])
            self.headings = np.where(moving, ways, self.headings)
            self.update(Course(self.headings, places[:, np.minimum(now + steps, last)]))

    def update(self, course: Course) -> None:
        self.tick += 1
        self.walkers.update(self.tick, np.arange(self.count), course)
        self.places.append(self.positions.copy())

    def frames(self, a_second: float = 60.0) -> Iterator[Frame]:
        """The frames that a client draws from the beginning to now."""
        drawn, told = no_steps(self.count), iter([*self.begun, None])
        stood = np.full((self.count, 2, 4), np.nan)
        after = next(told)
        for number in range(int(self.tick * TICK_S * a_second)):
            tick = number / a_second / TICK_S
            while after is not None and after.tick <= tick:
                landed = after.slots[drawn.share(after.tick)[after.slots] >= 1.0]
                stood[landed, 1 - drawn.on_right[landed].astype(np.int64)] = drawn.landing[landed]
                drawn.put(after.slots, after.steps)
                rows = np.arange(len(after.slots))
                side = after.steps.on_right.astype(np.int64)
                stood[after.slots, side[rows]] = after.steps.standing
                new = after.steps.ticks == 0
                stood[after.slots[new], 1 - side[new]] = after.steps.landing[new]
                after = next(told)
            share = drawn.share(tick)
            body = pose(drawn, share, self.sizes)
            before, rest = int(tick), tick - int(tick)
            places = (1.0 - rest) * self.places[before] + rest * self.places[before + 1]
            landed = np.flatnonzero(share >= 1.0)
            stood[landed, 1 - drawn.on_right[landed].astype(np.int64)] = drawn.landing[landed]
            slide_m = _slide(drawn, share, body, stood, self.sizes)
            yield Frame(tick, drawn, share, body, places, slide_m)

    def jumps(self) -> tuple[Floats, Floats, Floats]:
        """At every step that began: how far the hips, the ankles and the knees (that of the two
        that is further) were from where the step before had them at that moment, metres."""
        drawn = no_steps(self.count)
        out: list[tuple[Floats, Floats, Floats]] = []
        known = np.zeros(self.count, dtype=np.bool_)
        for begun in self.begun:
            rows = np.flatnonzero(known[begun.slots] & (begun.steps.ticks > 0))
            slots, new = begun.slots[rows], begun.steps.take(rows)
            old, sizes = drawn.take(slots), self.sizes.take(slots)
            before = pose(old, old.share(begun.tick), sizes)
            after = pose(new, new.share(begun.tick), sizes)
            out.append(
                (
                    np.linalg.norm(after.root - before.root, axis=1),
                    np.linalg.norm(after.ankles - before.ankles, axis=2).max(axis=1),
                    np.linalg.norm(after.knees - before.knees, axis=2).max(axis=1),
                )
            )
            drawn.put(begun.slots, begun.steps)
            known[begun.slots] = True
        root, ankles, knees = (np.concatenate(parts) for parts in zip(*out, strict=True))
        return root, ankles, knees

    def _course(self, velocities: Floats | None) -> Course:
        ahead = np.repeat(self.positions[:, None], AHEAD, axis=1)
        if velocities is not None:
            times = np.arange(AHEAD) * AHEAD_S
            ahead[..., :2] += velocities[:, None] * times[:, None]
        return Course(self.headings, ahead)

    def _publish(self, steps: Steps, slots: Slots) -> Steps:
        records = to_records(steps, slots)
        told = from_records(records)
        self.begun.append(Begun(self.tick, slots.copy(), told, records))
        return told


def _slide(steps: Steps, share: Floats, body: Pose, stood: Floats, sizes: BodySizes) -> Floats:
    """Distances (N, 2), metres, of heels (if the toe is up) or toes from where they stood."""
    rows = np.arange(len(share))
    right = steps.on_right.astype(np.int64)
    ahead = np.stack([np.cos(stood[..., 3]), np.sin(stood[..., 3])], axis=-1)
    toes = stood[..., :3].copy()
    toes[..., :2] += sizes.foot_m[:, None, None] * ahead
    off_heel = np.linalg.norm(body.ankles - stood[..., :3], axis=2)
    off_toe = np.linalg.norm(body.toes - toes, axis=2)
    out = np.full((len(share), 2), np.nan)
    on_heel = body.pitches[rows, right] > 0.0
    out[rows, right] = np.where(on_heel, off_heel[rows, right], off_toe[rows, right])
    flying = (steps.flight > 0.0) & (share > 1.0 - steps.flight)
    out[rows[flying], right[flying]] = np.nan
    pinned = share < steps.lift
    out[rows[pinned], 1 - right[pinned]] = off_toe[rows[pinned], 1 - right[pinned]]
    return out
