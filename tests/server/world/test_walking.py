import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from esplanade import scenes
from esplanade.actors import Population
from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.motion.key_poses import (
    ANKLE,
    ARMS,
    CHEST,
    KEYS,
    PELVIS,
    ROOT,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
    WIDTH,
    Steps,
    no_steps,
)
from esplanade.actors.locomotion.reference.posing import pose
from esplanade.planning import LayeredGrid
from esplanade.planning.scene.scene_file import read_scene
from esplanade.protocol.quaternions import from_angles, from_twist
from esplanade.protocol.steps import KEY_M, RE_AIMED
from esplanade.server.populating import populate
from esplanade.server.world.inputs import Detach, Leave, Steer
from esplanade.server.world.state import Floats
from esplanade.server.world.step_records import from_records, to_records
from esplanade.server.world.zone import Zone
from tests.actors.locomotion.handovers import handovers
from tests.server.worlds import FIELD, TICK_S, Trial, rules


def drawn(world: Zone) -> tuple[Floats, Floats]:
    """Hips as a client draws them at the end of this tick, and places of everyone, (N, 2) each."""
    slots = world.state.live()
    steps = from_records(world.steps.records[slots])
    sizes = BodySizes(world.state.legs_m[slots], world.state.statures_m[slots])
    hips = pose(steps, steps.share(world.tick), sizes).root[:, :2]
    return hips, world.state.positions[slots]


def in_a_thread(world: Zone) -> None:
    """Let a thread of its own take each tick's steps."""
    update = world.feet.update

    def elsewhere(tick: int) -> None:
        with ThreadPoolExecutor(1) as pool:
            pool.submit(update, tick).result()

    world.feet.update = elsewhere  # type: ignore[method-assign]


def test_who_comes_in_stands_there_on_legs_of_their_own() -> None:
    trial = Trial(scene=FIELD)
    ids = trial.join((50.0, 50.0), (60.0, 50.0))
    state, steps = trial.world.state, trial.world.steps
    slots = np.array([state.slot(avatar) for avatar in ids])
    assert steps.records["id"][slots].tolist() == ids
    assert steps.records["ticks"][slots].tolist() == [0, 0]
    assert (steps.begun[slots] == trial.world.tick).all()
    assert len(set(state.legs_m[slots].tolist())) == 2
    assert ((state.legs_m[slots] > 0.7) & (state.legs_m[slots] < 1.0)).all()
    assert ((state.statures_m[slots] > 1.3) & (state.statures_m[slots] < 2.0)).all()
    hips, places = drawn(trial.world)
    np.testing.assert_allclose(hips, places, atol=1e-3)


def test_a_person_walks_and_comes_to_stand() -> None:
    trial = Trial(scene=FIELD)
    (ann,) = trial.join((50.0, 50.0))
    trial.tick(Steer(ann, 1, 0.0, 1.3))
    trial.ticks(80)
    assert trial.world.feet.begun > 8
    hips, places = drawn(trial.world)
    assert np.hypot(*(hips - places).T).max() < 0.1
    trial.tick(Steer(ann, 2, 0.0, 0.0))
    trial.ticks(60)
    begun = trial.world.feet.begun
    hips, places = drawn(trial.world)
    np.testing.assert_allclose(hips, places, atol=2e-3)
    trial.ticks(40)
    assert trial.world.feet.begun == begun


def test_a_sudden_turn_changes_the_step_under_way() -> None:
    trial = Trial(scene=FIELD)
    (ann,) = trial.join((50.0, 50.0))
    trial.tick(Steer(ann, 1, 0.0, 1.3))
    trial.ticks(40)
    trial.tick(Steer(ann, 2, 2.5, 1.3))
    flags = []
    for _ in range(8):
        trial.tick()
        flags.append(int(trial.world.steps.records["flags"][trial.world.state.slot(ann)]))
    assert any(flag & RE_AIMED for flag in flags)


def test_a_slot_taken_again_is_somebody_else_who_stands() -> None:
    trial = Trial(scene=FIELD)
    (ann,) = trial.join((50.0, 50.0))
    trial.tick(Steer(ann, 1, 0.0, 1.3))
    trial.ticks(20)
    slot = trial.world.state.slot(ann)
    trial.tick(Leave(ann))
    (ben,) = trial.join((70.0, 70.0))
    assert trial.world.state.slot(ben) == slot
    record = trial.world.steps.records[slot]
    assert (int(record["id"]), int(record["ticks"])) == (ben, 0)
    assert trial.world.feet.lost == 0


def test_who_is_left_by_its_client_stands_still() -> None:
    trial = Trial(scene=FIELD)
    (ann,) = trial.join((50.0, 50.0))
    trial.tick(Steer(ann, 1, 0.0, 1.3))
    trial.ticks(20)
    trial.tick(Detach(ann))
    trial.ticks(60)
    hips, places = drawn(trial.world)
    np.testing.assert_allclose(hips, places, atol=2e-3)


def test_the_world_goes_on_without_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    trial = Trial(scene=FIELD)
    (ann,) = trial.join((50.0, 50.0))
    trial.tick(Steer(ann, 1, 0.0, 1.3))
    trial.ticks(10)

    def fail(*_: object) -> None:
        raise RuntimeError("told to fail")

    with monkeypatch.context() as broken:
        broken.setattr(trial.world.feet._walkers, "update", fail)
        trial.ticks(5)
    assert trial.world.feet.failures == 5
    trial.ticks(40)
    assert trial.world.feet.failures == 5
    hips, places = drawn(trial.world)
    assert np.hypot(*(hips - places).T).max() < 0.15


def test_same_inputs_give_the_same_steps_in_whatever_thread() -> None:
    worlds = []
    for elsewhere in (False, True):
        trial = Trial(scene=FIELD)
        if elsewhere:
            in_a_thread(trial.world)
        ids = trial.join((50.0, 50.0), (52.0, 51.0))
        trial.tick(*(Steer(avatar, 1, 0.3 * avatar, 1.4) for avatar in ids))
        trial.ticks(30)
        worlds.append(trial.world.steps.records.tobytes())
    assert worlds[0] == worlds[1]


def with_actors(name: str) -> tuple[Zone, Population]:
    """A world of that scene in which twelve actors are on their ways."""
    scene = read_scene(Path(scenes.__path__[0], name))
    grid = LayeredGrid.from_scene(scene)
    population, bodies = populate(grid, scene, 12, TICK_S, 5)
    world = Zone(
        scene, grid, population, bodies, rules(), tick_s=TICK_S, max_people=1, seed=5,
        clock=time.perf_counter,
    )  # fmt: skip
    return world, population


@pytest.mark.parametrize("name", ["plaza.json", "gallery.json"])
def test_actors_on_their_ways_are_drawn_where_they_are(name: str) -> None:
    world, population = with_actors(name)
    off = []
    for _ in range(300):
        world.begin([])
        world.finish(world.think())
        hips, places = drawn(world)
        off.append(np.hypot(*(hips - places).T))
    population.close()
    assert world.feet.failures == world.feet.lost == 0
    assert np.percentile(np.concatenate(off), 99) < 0.15
    assert np.percentile(np.concatenate(off), 50) < 0.05


def test_steps_of_actors_go_on_where_the_ones_before_ended() -> None:
    world, population = with_actors("gallery.json")
    state, pairs, slots = world.state, [], []
    before = world.steps.records.copy()
    for _ in range(400):
        world.begin([])
        world.finish(world.think())
        for slot in np.flatnonzero(world.steps.begun == world.tick).tolist():
            now = world.steps.records[slot : slot + 1].copy()
            if before["id"][slot] and now["ticks"][0]:
                pairs.append((before[slot : slot + 1].copy(), now))
                slots.append(slot)
            before[slot] = now[0]
    population.close()
    found = handovers(pairs, BodySizes(state.legs_m[slots], state.statures_m[slots]))
    whole = ~found.re_aimed
    assert whole.sum() > 200
    assert (np.array([old["standing"]["position"][0, 2] for old, _ in pairs]) > 0).any()
    for difference in (found.root, found.pelvis, found.pitches):
        assert not difference[whole].any()
    assert not found.footprint.any()
    assert found.drawn_ankles_m.max() < 3.0 * KEY_M


def test_records_keep_what_steps_are() -> None:
    random = np.random.default_rng(2)
    steps = no_steps(3)
    steps.on_right[:] = [True, False, True]
    steps.re_aimed[:] = [False, False, True]
    steps.start[:], steps.ticks[:] = [3, 70000, 12], [9, 0, 12]
    steps.standing[:] = random.uniform(-3.0, 3.0, (3, 4))
    steps.landing[:] = steps.standing + random.uniform(-0.9, 0.9, (3, 4))
    steps.lift[:] = [0.0, 1.0, 51 / 255]
    # Walks bend at the ends and go straight on between.
    ends = random.uniform(-0.2, 0.2, (2, 3, WIDTH))
    shares = np.linspace(0.0, 1.0, KEYS)[:, None]
    steps.keys[:] = (1.0 - shares) * ends[0][:, None] + shares * ends[1][:, None]
    steps.keys[:, -1, ANKLE] = steps.keys[:, -1, SWING_HEADING] = 0.0
    steps.keys[..., PELVIS] = from_angles(steps.keys[..., :3])
    steps.keys[..., CHEST] = from_twist(steps.keys[..., 14], steps.keys[..., 2])
    records = to_records(steps, np.array([4, 5, 6]))
    known = from_records(records)
    assert records["id"].tolist() == [4, 5, 6]
    for name in ("on_right", "re_aimed", "start", "ticks", "lift"):
        np.testing.assert_array_equal(getattr(known, name), getattr(steps, name))
    same = np.sign(np.einsum("nkd,nkd->nk", known.keys[..., PELVIS], steps.keys[..., PELVIS]))
    keys = known.keys.copy()
    keys[..., PELVIS] *= same[..., None]
    for columns, ends_within, within in (
        (ROOT, 1.5e-4, 1.5e-3),
        (PELVIS, 2e-3, 5e-3),
        (ANKLE, 1.5e-4, 3e-3),
        (SWING_PITCH, 1e-4, 2e-3),
        (STANDING_PITCH, 1e-4, 2e-3),
        (SWING_HEADING, 1.5e-4, 2e-3),
        (CHEST, 2e-3, 5e-3),
        (ARMS, 7e-3, 1.3e-2),
    ):
        apart = np.abs(keys[..., columns] - steps.keys[..., columns])
        assert apart.max() <= within, columns
        assert apart[:, [0, -1]].max() <= ends_within, columns
    again = from_records(to_records(known, np.array([4, 5, 6])))
    for one, other in zip(known[:-1], again[:-1], strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)
    np.testing.assert_allclose(known.keys[:, [0, -1]], again.keys[:, [0, -1]], atol=1e-12)


def test_a_step_over_stands_in_its_last_pose() -> None:
    steps: Steps = no_steps(2)
    steps.start[:], steps.ticks[:] = 10, [4, 0]
    assert steps.share(9).tolist() == [0.0, 1.0]
    assert steps.share(12).tolist() == [0.5, 1.0]
    assert steps.share(20).tolist() == [1.0, 1.0]


def test_a_stride_makes_steps_shorter_or_longer_at_the_same_speed() -> None:
    trial = Trial(scene=FIELD)
    ids = trial.join((50.0, 50.0), (50.0, 55.0), (50.0, 60.0))
    state, steps = trial.world.state, trial.world.steps
    slots = state.slots_of(ids)
    state.strides[slots] = 0.6, 1.0, 1.2
    trial.tick(*(Steer(each, 1, 0.0, 1.2) for each in ids))
    trial.ticks(60)
    walked = from_records(steps.records[slots])
    lengths = np.hypot(*(walked.landing - walked.standing)[:, :2].T) / state.legs_m[slots]
    assert (np.diff(lengths) > 0.08).all()
    hips, places = drawn(trial.world)
    assert np.hypot(*(hips - places).T).max() < 0.1


def test_the_stride_of_actors_is_a_parameter_of_theirs() -> None:
    world, population = with_actors("plaza.json")
    world.begin([])
    world.finish(world.think())
    actor = population.table.ids[0]
    longer = population.navigator.parameters(actor).model_copy(update={"stride": 1.2})
    population.set_parameters(actor, longer)
    world.begin([])
    world.finish(world.think())
    strides = world.state.strides[world.state.live()]
    population.close()
    assert sorted(strides.tolist())[-2:] == [1.0, 1.2]
