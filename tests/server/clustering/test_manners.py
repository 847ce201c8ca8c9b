"""Gestures, looks, and who is away, between people of two gateways."""

from esplanade.protocol import VERSION, Gesture
from esplanade.protocol.looks import Look
from esplanade.protocol.messages import Away, ChooseLook, GestureMade, Hello, MakeGesture, Presence
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


async def test_looks_go_from_gateway_to_gateway_and_come_back(at_town: Cluster) -> None:
    east, west = at_town.gateways
    red, blue = Look(shirt=1, skin=2, stature_cm=185), Look(shirt=2, hair=3, stature_cm=160)
    async with joined(west.port, "Ben", OTHER) as ben:
        async with joined(east.port, "Ann", PLACE, look=red) as ann:
            await sees(ben, ann)
            assert ben.entities[ann.id].look == red
            await ann.send(ChooseLook(look=blue))
            await ben.wait_for(lambda: ben.entities[ann.id].look == blue)
            assert round(ben.entities[ann.id].stature_m, 3) == 1.6
            assert ann.welcome is not None
            token = ann.welcome.resume
            ann.connection.transport.abort()
        async with joined(west.port, "Ann", resume=token) as again:
            assert (again.id, again.entities[again.id].look) == (ann.id, blue)
