"""Of each person the latest movement waits for the tick, however it came."""

from esplanade.server.metrics import Metrics
from esplanade.server.net.pending_inputs import PendingInputs
from esplanade.server.world.inputs import Follow, Input, Stand, Steer, SteerMany


def wanted(pending: PendingInputs) -> list[Input]:
    """The inputs of a tick; many steerings as they would be one by one."""
    found: list[Input] = []
    for item in pending.drain([], [], still=False):
        if isinstance(item, SteerMany):
            parts = item.ids, item.seqs, item.directions_rad.tolist(), item.speeds_mps.tolist()
            found += [Steer(*each) for each in zip(*parts, strict=True)]
        else:
            found.append(item)
    return found


def test_the_latest_movement_wins_whether_it_came_alone_or_with_others() -> None:
    metrics = Metrics()
    pending = PendingInputs(metrics)
    pending.move(Follow(1, 4, ()))
    pending.steer({1: (5, 0.5, 1.0), 2: (7, -1.0, 0.0)})
    pending.move(Steer(2, 8, 0.0, 1.0))
    pending.steer({3: (1, 0.0, 1.0)})
    pending.steer({3: (2, 0.25, 1.0)})
    assert wanted(pending) == [
        Steer(2, 8, 0.0, 1.0),
        Steer(1, 5, 0.5, 1.0),
        Steer(3, 2, 0.25, 1.0),
    ]
    assert metrics.traffic.movements_superseded == 3
    assert wanted(pending) == []


def test_movements_of_those_who_stand_or_are_gone_are_void_and_others_wait_for_time() -> None:
    pending = PendingInputs(Metrics())
    pending.steer({1: (5, 0.5, 1.0), 2: (7, -1.0, 0.0), 3: (1, 0.0, 1.0)})
    pending.stand(1)
    pending.forget(2)
    assert pending.drain([], [], still=True) == [Stand(1)]
    assert wanted(pending) == [Steer(3, 1, 0.0, 1.0)]
