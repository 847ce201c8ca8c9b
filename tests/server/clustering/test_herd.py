"""All gateways are restarted at once, and everybody comes back to the same avatar."""

from chaos.cluster.herd import restart_gateways

from esplanade.protocol import ErrorCode
from tests.server.clustering.clusters import Cluster

PEOPLE = 120


async def test_a_herd_comes_back_and_nobody_is_refused_but_for_a_moment(at_town: Cluster) -> None:
    done = await restart_gateways(at_town, PEOPLE)
    assert done.faults == []
    assert set(done.refusals) <= {str(ErrorCode.BUSY)}
