"""A process dies within a hop, and the person is in exactly one zone afterwards.

Here each step and each victim comes at least once; `make chaos-cluster` has all fifteen cases.
"""

import pytest
from chaos.cluster.deaths import Victim, die
from chaos.cluster.held_hops import Step

from tests.server.clustering.clusters import Cluster


@pytest.mark.parametrize(
    ("step", "victim"),
    [
        (Step.ASKED, Victim.DESTINATION),
        (Step.KEPT, Victim.GATEWAY),
        (Step.MOVING, Victim.ORIGIN),
        (Step.MOVED, Victim.GATEWAY),
        (Step.FOLLOWED, Victim.DESTINATION),
    ],
    ids=lambda each: each.value,
)
async def test_whoever_hops_while_a_process_dies_is_in_one_zone_afterwards(
    at_town: Cluster, step: Step, victim: Victim
) -> None:
    death = await die(at_town, step, victim)
    assert death.faults == []
