import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.server.world.contacts import Contacts
from esplanade.server.world.inputs import Leave, Steer
from esplanade.server.world.state import PERSON, State
from tests.naive.contacts import NaiveContacts, closest_approach
from tests.server.doubles import ScriptedPopulation
from tests.server.worlds import FIELD, TICK_S, Trial


def trial_with(*actors: tuple[tuple[float, float], tuple[float, float]]) -> Trial:
    population = ScriptedPopulation(TICK_S)
    for number, (position, velocity) in enumerate(actors):
        population.put(f"a{number}", position, velocity)
    return Trial(scene=FIELD, population=population)


def test_a_contact_counts_once_until_the_pair_has_parted() -> None:
    trial = trial_with(((50.0, 50.0), (0.0, 0.0)))
    (ann,) = trial.join((49.0, 50.0))
    trial.tick(Steer(ann, 1, 0.0, 1.0))
    trial.ticks(25)
    assert trial.world.contacts.actor_person == 1
    trial.ticks(30)
    assert trial.position(ann)[0] > 51.0
    trial.tick(Steer(ann, 2, math.pi, 1.0))
    trial.ticks(30)
    assert trial.world.contacts.actor_person == 2


def test_a_fast_crossing_between_two_ticks_is_seen() -> None:
    trial = trial_with(((50.0, 50.0), (0.0, 40.0)))
    trial.join((50.0, 53.0))
    assert trial.world.contacts.actor_person == 0
    trial.tick()
    assert trial.world.contacts.actor_person == 1


def test_those_who_pass_at_arms_length_do_not_touch() -> None:
    trial = trial_with(((50.0, 50.0), (1.0, 0.0)))
    trial.join((52.0, 50.51))
    trial.ticks(80)
    assert trial.world.contacts.actor_person == 0


def test_two_actors_count_as_one_contact_of_their_own_kind() -> None:
    trial = trial_with(((50.0, 50.0), (1.0, 0.0)), ((52.0, 50.0), (-1.0, 0.0)))
    trial.ticks(60)
    assert trial.world.contacts.actor_actor == 1
    assert trial.world.contacts.actor_person == 0


def test_people_among_themselves_are_not_counted() -> None:
    trial = trial_with(((150.0, 150.0), (0.0, 0.0)))
    trial.join((10.0, 10.0), (10.1, 10.0))
    assert trial.world.contacts.actor_person == 0


def test_a_person_who_takes_the_slot_of_another_is_somebody_else() -> None:
    trial = trial_with(((50.0, 50.0), (0.0, 0.0)))
    (ann,) = trial.join((50.0, 50.0))
    assert trial.world.contacts.actor_person == 1
    trial.tick(Leave(ann))
    trial.join((50.0, 50.0))
    assert trial.world.contacts.actor_person == 2


def test_closest_approach_matches_sampling_the_motion() -> None:
    random = np.random.default_rng(4)
    state = State(40)
    for x, y in random.uniform(0.0, 3.0, (40, 2)):
        state.add(PERSON, "p", (float(x), float(y), 0.0), 0, 0.25)
    state.before[:] = state.positions
    state.positions += random.normal(0.0, 0.8, (40, 2))
    part = np.linspace(0.0, 1.0, 2001)[:, None, None]
    way = state.before + part * (state.positions - state.before)
    for one, other in zip(range(0, 40, 2), range(1, 40, 2), strict=True):
        sampled = np.linalg.norm(way[:, one] - way[:, other], axis=1).min()
        assert closest_approach(state, one, other) == pytest.approx(sampled, abs=2e-3)


@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 2.0, 12.0, 300.0]))
def test_contacts_are_those_of_everyone_against_everyone(seed: int, wide_m: float) -> None:
    """In crowds and in the open, on two floors, with jumps, departures and arrivals."""
    random = np.random.default_rng(seed)
    state = State(30)

    def arrive() -> None:
        kind, (x, y) = int(random.integers(2)), random.uniform(0.0, wide_m, 2)
        z = float(random.choice([0.0, 1.0, 3.0]))
        state.add(kind, "a", (float(x), float(y), z), 0, float(random.uniform(0.1, 0.9)))

    for _ in range(25):
        arrive()
    contacts, naive = Contacts(), NaiveContacts()
    for _ in range(12):
        state.before[:] = state.positions
        state.positions += random.normal(0.0, 0.1, (30, 2))
        jumps = random.random(30) < 0.1
        state.positions[jumps] += random.normal(0.0, 3.0, (int(jumps.sum()), 2))
        if random.random() < 0.4:
            state.remove(int(random.choice(state.ids[state.live()])))
        if random.random() < 0.4 and len(state.live()) < state.capacity:
            arrive()
        contacts.update(state)
        naive.update(state)
        found = contacts.actor_person, contacts.actor_actor
        assert found == (naive.actor_person, naive.actor_actor)
