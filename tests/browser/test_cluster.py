"""Two pages at two gateways of one world, while processes of it are killed."""

from collections.abc import Iterator
from typing import Final

import pytest
from playwright.async_api import BrowserContext

from tests.browser.visitor import Visitor, avatar_of, moved_m, own
from tests.browser.worlds import built
from tests.patience import COMPILING_PATIENCE_S, PATIENCE_S
from tests.server.brokers import nats_server
from tests.server.clustering.balancer import balancing
from tests.server.clustering.clusters import Cluster, Gateway, cluster
from tests.server.databases import postgresql_server
from tests.server.zones import write_town

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

PATIENT: Final = ("--drop-seconds", f"{PATIENCE_S:g}", "--hello-timeout-s", "60")
"""Options of gateways that drop no page because its machine is slow."""
STEP_M: Final = 0.3


@pytest.fixture(scope="module")
def yard(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    """A cluster of two gateways, with an owner of the yard and a host that stands by."""
    built("index.html")
    with (
        nats_server() as broker,
        postgresql_server() as database,
        cluster(database.address, broker, resume_s=PATIENCE_S) as made,
    ):
        made.init(write_town(tmp_path_factory.mktemp("town")))
        hosts = [made.host("yard", name=name) for name in ("oak", "elm")]
        gateways = [made.gateway(*PATIENT, name=name) for name in ("east", "west")]
        for host in hosts:
            host.wait_for("ready to claim", COMPILING_PATIENCE_S)
        for gateway in gateways:
            gateway.wait_for("open")
        yield made


def address(port: int) -> str:
    return f"http://127.0.0.1:{port}/"


async def test_two_pages_at_two_gateways_outlive_a_gateway_and_the_host_of_their_zone(
    yard: Cluster, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    east, west = (each for each in yard.processes if isinstance(each, Gateway))
    async with balancing([east.port, west.port]) as port:
        ann = await Visitor.arrive(profile, address(port))
        ben = await Visitor.arrive(other_profile, address(west.port))
        await ann.join("Ann")
        await ben.join("Ben")
        hers, his = (await ann.look())["id"], (await ben.look())["id"]
        await ann.until(lambda view: avatar_of(view, his) is not None)
        await ben.until(lambda view: avatar_of(view, hers) is not None)

        east.kill()
        await ann.page.get_by_text("Welcome back, Ann.").wait_for()
        view = await ann.until(lambda view: view["phase"] == "live" and own(view) is not None)
        assert view["id"] == hers
        await ann.until(lambda view: avatar_of(view, his) is not None)
        await ben.until(lambda view: avatar_of(view, hers) is not None)

        epoch, standing_by = yard.owner("yard")[1], yard.standing_by()
        standing_by.freeze()  # until both pages have told their people
        yard.owning("yard").kill()
        silent = "This place does not answer just now."
        for each in (ann, ben):
            await each.page.get_by_text(silent).wait_for()
            assert await each.page.locator("#picture").is_visible()
            assert await each.page.locator("#banner").is_hidden()
        standing_by.thaw()
        assert await yard.taken_over("yard", epoch) is standing_by
        for each in (ann, ben):
            await each.page.get_by_text(silent).wait_for(state="hidden")
        before = avatar_of(await ben.until(lambda view: avatar_of(view, hers) is not None), hers)
        assert before is not None
        await ann.page.keyboard.down("s")
        await ben.until(lambda view: moved_m(view, before) > STEP_M)
        await ann.page.keyboard.up("s")
        view = await ann.look()
        assert (view["phase"], view["id"]) == ("live", hers)
        assert [each for each in view["avatars"] if each["id"] == his] != []
        for each in (ann, ben):
            assert [fault for fault in each.faults if fault.startswith("exception")] == []
