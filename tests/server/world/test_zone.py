import math

import msgpack
import numpy as np

from esplanade.actors import Population
from esplanade.planning import LayeredGrid
from esplanade.protocol import Kind
from esplanade.protocol.snapshot import RECORD
from esplanade.server.populating import populate
from esplanade.server.world.audience import Audience, News
from esplanade.server.world.inputs import (
    Attach,
    Detach,
    Follow,
    Input,
    Join,
    Leave,
    Stand,
    Steer,
    Watch,
)
from esplanade.server.world.stage_times import STAGES
from esplanade.server.world.state import ACTOR
from esplanade.server.world.zone import Zone
from tests.server.doubles import ScriptedPopulation
from tests.server.worlds import ROOM, TICK_S, Trial, block_of, entered_ids, rules


def recorded(ticks: int) -> list[list[Input]]:
    """Inputs of eight people, tick by tick, the same in every run."""
    random = np.random.default_rng(12)
    record: list[list[Input]] = [[Join(k, f"p{k}", None) for k in range(8)]]
    first_person = 4
    for tick in range(1, ticks):
        who = int(first_person + random.integers(8))
        choice = random.uniform()
        inputs: list[Input] = []
        if choice < 0.4:
            inputs.append(Steer(who, tick, float(random.uniform(0.0, 6.3)), 1.4))
        elif choice < 0.5:
            inputs.append(
                Follow(who, tick, ((5.0, 17.0, 0), (float(random.uniform(6.0, 19.0)), 17.0, 0)))
            )
        elif choice < 0.51:
            inputs.append(Detach(who))
        elif choice < 0.515:
            inputs.append(Stand(who))
        elif choice < 0.52:
            inputs += [Leave(who), Join(100 + tick, "late", (5.0, 5.0, 0))]
        record.append(inputs)
    return record


def replay(record: list[list[Input]]) -> bytes:
    """Every byte of the world's story: all positions, and all that viewers are sent."""
    grid = LayeredGrid.from_scene(ROOM)
    population: Population
    population, bodies = populate(grid, ROOM, 3, TICK_S, seed=7)
    world = Zone(
        ROOM,
        grid,
        population,
        bodies,
        rules(),
        tick_s=TICK_S,
        max_people=32,
        seed=7,
        clock=lambda: 0.0,
    )
    audience = Audience(world.rules, world.origin_m, world.times)
    story = bytearray()
    for inputs in [[], *record]:
        world.begin(inputs)
        news = audience.take(world.finish(world.think()))
        audience.wrote(news.snapshots, list(range(len(news.snapshots.viewers))))
        story += world.state.positions.tobytes() + news.snapshots.records.tobytes()
        story += news.snapshots.steps.tobytes() + repr((news.entered, news.left)).encode()
    story += repr((world.trips, world.contacts.actor_person, world.state.names)).encode()
    population.close()
    return bytes(story)


def test_same_seed_and_same_inputs_give_the_same_world_bit_for_bit() -> None:
    record = recorded(120)
    assert replay(record) == replay(record)


def test_every_stage_of_a_tick_is_timed_in_order() -> None:
    trial = Trial()
    trial.tick()
    assert set(trial.world.times.seconds) == set(STAGES)
    assert all(seconds > 0.0 for seconds in trial.world.times.seconds.values())


def test_inputs_of_people_who_are_gone_are_void() -> None:
    trial = Trial()
    (ann,) = trial.join((3.0, 3.0))
    trial.tick(Leave(ann))
    trial.tick(Steer(ann, 1, 0.0, 1.0), Follow(ann, 2, ((4.0, 4.0, 0),)), Leave(ann), Detach(999))
    assert trial.world.count() == (0, 0)


def test_actors_see_the_people_of_this_tick_and_people_the_actors() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (5.0, 5.0), (1.0, 0.0))
    trial = Trial(population=population)
    news = trial.tick(Join(0, "Ann", (3.0, 3.0, 0)))
    ((_, ann),) = trial.joined
    trial.tick(Steer(ann, 1, math.pi / 2.0, 1.0))
    assert population.observed == {ann: (*trial.position(ann), 0)}
    state = trial.world.state
    (oak,) = [int(i) for i in state.ids[state.alive] if trial.world.is_actor(int(i))]
    (described,) = [e for e in map(msgpack.unpackb, news.entered[ann]) if e["id"] == oak]
    assert described["kind"] == Kind.ACTOR.value
    assert described["name"] == "oak"
    assert trial.speed(oak) == 1.0
    assert trial.world.explain(oak).behaviour == "patrol"
    assert trial.world.count() == (1, 1)


def test_actors_stand_when_there_is_no_plan() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (5.0, 5.0), (1.0, 0.0))
    trial = Trial(population=population)
    trial.tick()
    trial.world.begin([])
    trial.world.finish(False)
    assert trial.world.state.speeds.max() == 0.0


def test_what_an_actor_points_at_is_told_when_it_changes_and_to_who_comes() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (4.0, 3.0))
    population.put("elm", (5.0, 3.0))
    trial = Trial(population=population)
    assert trial.frame().events.pointing == {}
    oak, elm = (int(i) for i in trial.world.state.ids[trial.world.state.live()])
    population.pointed_at["oak"] = (1.0, 2.0, 3.0)
    assert trial.frame().events.pointing == {oak: (1.0, 2.0, 3.0)}
    assert trial.frame().events.pointing == {}
    population.pointed_at = {"oak": (4.0, 2.0, 3.0), "elm": (1.0, 2.0, 3.0)}
    assert trial.frame().events.pointing == {oak: (4.0, 2.0, 3.0), elm: (1.0, 2.0, 3.0)}
    population.pointed_at = {}
    assert trial.frame().events.pointing == {oak: None, elm: None}


def test_who_comes_is_told_what_actors_point_at_and_who_is_there_sees_it_change() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (4.0, 3.0))
    trial = Trial(population=population)
    trial.tick()
    (oak,) = trial.world.state.ids[trial.world.state.live()].tolist()

    def told_on_coming() -> tuple[int, dict[int, list[float] | None]]:
        news = trial.tick(Join(0, "Ann", (3.0, 3.0, 0)))
        ((_, ann),) = trial.joined
        entities = map(msgpack.unpackb, news.entered[ann])
        return ann, {entity["id"]: entity["points_at"] for entity in entities}

    ann, told = told_on_coming()
    assert told == {ann: None, oak: None}
    population.pointed_at["oak"] = (1.0, 2.0, 3.0)
    assert trial.tick().pointing == {oak: ((1.0, 2.0, 3.0), [ann])}
    ben, told = told_on_coming()
    assert told == {ann: None, ben: None, oak: [1.0, 2.0, 3.0]}
    population.pointed_at = {}
    assert trial.tick().pointing == {oak: (None, [ann, ben])}
    assert told_on_coming()[1][oak] is None


def test_plans_of_watched_actors_are_in_frames_five_times_a_second() -> None:
    population = ScriptedPopulation(TICK_S)
    population.put("oak", (4.0, 3.0))
    trial = Trial(population=population)
    (ann,) = trial.join((3.0, 3.0))
    (oak,) = trial.world.state.ids[trial.world.state.of_kind(ACTOR)].tolist()
    assert not any(trial.frame().events.plans for _ in range(8))
    plans = [trial.frame(Watch(ann, oak)).events.plans, trial.frame().events.plans]
    plans += [trial.frame().events.plans for _ in range(6)]
    assert [list(plan) for plan in plans if plan] == [[oak], [oak]]
    for over in (Watch(ann, None), Watch(ann, ann), Detach(ann)):
        trial.frame(Watch(ann, oak), over)
        assert not any(trial.frame().events.plans for _ in range(8))


def test_whoever_comes_back_is_attached_once_by_the_latest_ticket() -> None:
    trial = Trial()
    (ann,) = trial.join((3.0, 3.0))
    frame = trial.frame(Detach(ann), Attach(ann, 7), Detach(ann), Attach(ann, 8))
    assert (frame.attached, set(frame.detached)) == ([(8, ann)], {ann})


def test_frames_alone_make_the_news_the_same_for_another_audience() -> None:
    """A second audience that is handed the frames says the same, byte by byte."""
    random = np.random.default_rng(5)
    trial = Trial(view_radius_m=6.0, view_limit=9)
    other = Audience(trial.world.rules, trial.world.origin_m, trial.world.times)
    here: list[int] = []
    for tick in range(150):
        inputs: list[Input] = [
            Steer(who, tick, float(random.uniform(0.0, 6.3)), 2.0)
            for who in here
            if random.uniform() < 0.2
        ]
        inputs += [Join(tick, f"p{tick}", None)] if random.uniform() < 0.3 else []
        if here and random.uniform() < 0.1:
            inputs.append(Leave(here.pop(0)))
        frame = trial.frame(*inputs)
        here += [avatar_id for _, avatar_id in frame.joined]
        one, two = trial.audience.take(frame), other.take(frame)
        read = [k for k in range(len(one.snapshots.viewers)) if random.uniform() < 0.8]
        for audience, news in ((trial.audience, one), (other, two)):
            audience.wrote(news.snapshots, read)
        assert (one.left, one.entered) == (two.left, two.entered)
        assert one.snapshots.records.tobytes() == two.snapshots.records.tobytes()
        assert one.snapshots.steps.tobytes() == two.snapshots.steps.tobytes()
    assert len(here) > 20


def test_who_is_told_to_stand_stands_and_may_walk_again() -> None:
    trial = Trial()
    walker, follower = trial.join((3.0, 3.0), (3.0, 6.0))
    route = ((9.0, 6.0, 0.0),)
    trial.tick(Steer(walker, 1, 0.0, 1.0), Follow(follower, 1, route))
    assert trial.world.moves(walker)
    assert trial.world.moves(follower)
    trial.tick(Stand(walker), Stand(follower))
    stood = [trial.position(who) for who in (walker, follower)]
    trial.ticks(5)
    assert [trial.position(who) for who in (walker, follower)] == stood
    assert not trial.world.moves(walker)
    assert not trial.world.moves(follower)
    trial.tick(Steer(walker, 2, 0.0, 1.0))
    assert trial.position(walker)[0] > stood[0][0]
    trial.tick(Leave(walker), Stand(walker))
    assert not trial.world.moves(walker)


def test_whoever_comes_back_from_another_zone_is_told_of_as_a_newcomer() -> None:
    trial = Trial()
    near, far = trial.join((5.0, 5.0), (6.0, 5.0))
    steps_before = trial.world.feet.begun
    trial.tick(Leave(far))
    # The same id, the same place and the same slot, after one tick or within one.
    news = trial.tick(Join(7, "p1", (6.0, 5.0, 0.0), id=far))
    assert trial.joined == [(7, far)]
    assert entered_ids(news, near) == [far]
    assert far in block_ids(news, near)
    assert trial.world.feet.begun > steps_before
    news = trial.tick(Leave(far), Join(8, "p1", (6.0, 5.0, 0.0), id=far))
    assert (news.left[near], entered_ids(news, near)) == ([far], [far])
    assert far in block_ids(news, near)


def test_nobody_comes_in_who_is_here_already() -> None:
    trial = Trial()
    (ann,) = trial.join((5.0, 5.0))
    trial.tick(Join(7, "p0", (8.0, 5.0, 0.0), id=ann))
    assert trial.joined == []
    assert trial.world.failures == 1
    assert trial.position(ann) == (5.0, 5.0)


def block_ids(news: News, viewer: int) -> list[int]:
    """Ids of the records that this viewer is to be sent."""
    return list(np.frombuffer(block_of(news, viewer), dtype=RECORD)["id"])
