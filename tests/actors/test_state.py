"""The state that an actor shows; its reasons are those of the wire."""

import numpy as np

from esplanade import protocol
from esplanade.actors import ActorState, Outcome, Reason


def test_reasons_are_those_of_the_protocol() -> None:
    assert {r.name: r.value for r in Reason} == {r.name: r.value for r in protocol.Reason}


def test_outcomes_are_those_of_the_protocol() -> None:
    assert {o.name: o.value for o in Outcome} == {o.name: o.value for o in protocol.Outcome}


def test_the_path_carries_heights_and_time() -> None:
    way = np.array([[1.0, 2.0, 3.0], [1.2, 2.0, 3.2], [1.4, 2.1, 3.4]])
    state = ActorState((1.0, 2.0), 1, 3.0, (1.0, 0.0), 0.0, Reason.MOVING, None, 0.2, way)
    assert state.path.tolist() == [[1.0, 2.0, 3.0, 0.0], [1.2, 2.0, 3.2, 0.2], [1.4, 2.1, 3.4, 0.4]]
