import pytest

from esplanade.server.world.state import ACTOR, PERSON, State, WorldFullError


def test_slots_are_used_again_but_ids_never() -> None:
    state = State(2)
    first = state.add(PERSON, "Ann", (1.0, 2.0, 0.0), 0, 0.25)
    first_id = int(state.ids[first])
    assert state.remove(first_id) == first
    second = state.add(PERSON, "Ben", (3.0, 4.0, 0.0), 0, 0.25)
    assert second == first
    assert state.ids[second] != first_id
    assert first_id not in state
    assert state.slot(int(state.ids[second])) == second


def test_a_new_avatar_keeps_nothing_of_the_one_before_it() -> None:
    state = State(1)
    slot = state.add(ACTOR, "Oak", (1.0, 2.0, 0.0), 0, 0.3)
    state.speeds[slot], state.headings[slot], state.reasons[slot] = 1.0, 2.0, 3
    state.remove(int(state.ids[slot]))
    slot = state.add(PERSON, "Ann", (5.0, 6.0, 0.0), 0, 0.25)
    assert (state.speeds[slot], state.headings[slot], state.reasons[slot]) == (0.0, 0.0, 0)
    assert state.before[slot].tolist() == [5.0, 6.0]
    assert state.of_kind(PERSON).tolist() == [slot]
    assert state.of_kind(ACTOR).tolist() == []


def test_a_full_world_says_so() -> None:
    state = State(1)
    state.add(PERSON, "Ann", (0.0, 0.0, 0.0), 0, 0.25)
    with pytest.raises(WorldFullError, match="1 avatars"):
        state.add(PERSON, "Ben", (0.0, 0.0, 0.0), 0, 0.25)
