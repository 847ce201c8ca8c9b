"""Gestures, and who is away, between people of two gateways."""

from esplanade.protocol import VERSION, Gesture
from esplanade.protocol.messages import Away, GestureMade, Hello, MakeGesture, Presence
from tests.server.client import PLACING_KEY, connected, joined
from tests.server.clustering.clusters import Cluster
from tests.server.clustering.people import sees

PLACE = (6.0, 10.0, 0)
OTHER = (6.0, 12.0, 0)


async def test_gestures_and_who_is_away_go_from_gateway_to_gateway(at_town: Cluster) -> None:
    east, west = at_town.gateways
    async with joined(east.port, "Ann", PLACE) as ann, joined(west.port, "Ben", OTHER) as ben:
        await sees(ben, ann)
        await ann.send(Presence(away=True))
        assert await ben.until(Away) == Away(id=ann.id, away=True)
        await ann.send(MakeGesture(gesture=Gesture.WAVE))
        assert await ben.until(GestureMade) == GestureMade(id=ann.id, gesture=Gesture.WAVE)
        async with connected(west.port) as cid:
            hello = Hello(name="Cid", version=VERSION, at=OTHER, operator=PLACING_KEY)
            await cid.send(hello)
            assert await cid.until(Away) == Away(id=ann.id, away=True)
