"""A digest of all bytes that clients get, taken before and after a change that changes nothing.

python -m benchmarks.same_world --ticks 2000 --clients 50

Scripted people steer, walk to places, talk, watch actors, move doors, leave and come back in the
gallery. Their sessions are the server's own, over connections that only keep what is written.
Welcomes hold tokens and are left out. Compare digests of one machine only: compiled code may round
otherwise on another kind of processor.
"""

import argparse
import asyncio
import hashlib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Final, cast

import numpy as np
from websockets.protocol import State

from esplanade.commandline.progress import progress
from esplanade.protocol import VERSION, ServerCode, decode_client, encode
from esplanade.protocol.messages import ChatLine, Hello, Move, SetDoor, WalkTo, Watch
from esplanade.server.building import build_world
from esplanade.server.loading import load_scene
from esplanade.server.metrics import Metrics
from esplanade.server.moderation.state import ModerationState
from esplanade.server.net.connection import Connection
from esplanade.server.net.delivery import Delivery
from esplanade.server.net.hub import Hub
from esplanade.server.net.refusals import Refusals
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.search_budget import SearchBudget, Share
from esplanade.server.net.session import Session
from esplanade.server.net.sockets.system import NONE
from esplanade.server.settings import ServerSettings
from esplanade.server.store.store import Store
from esplanade.server.world.audience import Audience

KEY: Final = "key"
LEFT_OUT: Final = {int(ServerCode.WELCOME), int(ServerCode.PONG)}
SETTINGS: Final = {"seed": 7, "actors": 20, "operator_key": KEY, "max_clients": 80}


class KeptConnection:
    """A connection, its transport and its socket in one; it keeps the frames that are written."""

    state = State.OPEN
    close_code = 1006
    client_address = "127.0.0.1"
    descriptor = NONE

    def __init__(self) -> None:
        self.transport = self
        self.closing: list[object] = []
        self.frames: list[bytes] = []

    @property
    def heard(self) -> bool:
        """A scripted client is never taken for silent."""
        return True

    @heard.setter
    def heard(self, _: bool) -> None:
        pass

    def write(self, frame: bytes) -> None:
        self.frames.append(bytes(frame))

    def get_write_buffer_size(self) -> int:
        return 0

    def get_extra_info(self, _: str) -> "KeptConnection":
        return self

    def setsockopt(self, *_: object) -> None:
        pass

    def abort(self) -> None:
        pass

    async def close(self, *_: object) -> None:
        pass


class Visitors:
    """Scripted people, each with a session and a digest of what it was sent."""

    def __init__(self, hub: Hub, world: Any, settings: ServerSettings, count: int) -> None:
        self._hub, self._world, self._settings = hub, world, settings
        self._metrics = Metrics()
        self._rng = np.random.default_rng(3)
        self._seq = 0
        scene = world.scene
        self._places = [(*place.position, place.z_m) for place in scene.places]
        self._doors = [door.name for door in scene.doors]
        self.digests = [hashlib.sha256() for _ in range(count)]
        self.sessions = [self._come(k) for k in range(count)]

    def _come(self, k: int, token: str | None = None) -> Session:
        connection = cast(Connection, KeptConnection())
        session = Session(
            connection, self._hub, self._settings, self._metrics, Refusals(self._metrics)
        )
        hello = Hello(
            name=f"p{k}",
            version=VERSION,
            resume=token,
            at=self._places[k % len(self._places)] if k % 2 else None,
            operator=KEY if k == 0 else None,
        )
        session.name = hello.name
        self._hub.admit(session, cast(Hello, decode_client(encode(hello))))
        return session

    def act(self, tick: int) -> None:
        """Everyone who is welcome may send a message; now and then somebody goes and comes back."""
        for k, session in enumerate(self.sessions):
            chances = self._rng.random(6)
            if session.avatar_id is None:
                continue
            self._seq += 1
            message = self._message(k, tick, chances)
            if message is not None:
                session._take(decode_client(encode(message)))  # noqa: SLF001 - as if it was read
            if chances[4] < 0.0005:
                self._hub.depart(session, comes_back=bool(chances[5] < 0.7))
                self.sessions[k] = self._come(k, session.token)

    def _message(self, k: int, tick: int, u: Any) -> Any:
        x0, y0, x1, y1 = self._world.scene.bounds
        message: Any = None
        if u[0] < 0.02:
            message = Move(seq=self._seq, direction=float(u[1] * 6.28), speed=float(3.5 * u[2]))
        elif u[0] < 0.025:
            x, y, z = self._places[int(u[1] * len(self._places))]
            message = WalkTo(seq=self._seq, x=x + u[2] - 0.5, y=y + u[3] - 0.5, z=z)
        elif u[0] < 0.027:
            x, y = x0 + u[1] * (x1 - x0), y0 + u[2] * (y1 - y0)
            message = WalkTo(seq=self._seq, x=x, y=y, z=0.0)
        elif u[0] < 0.028:
            message = Move(seq=self._seq, direction=0.0, speed=0.0)
        elif u[0] < 0.029:
            message = ChatLine(text=f"line {tick} of {k}")
        elif u[0] < 0.033:
            message = Watch(id=int(1 + u[1] * 20))
        elif u[0] < 0.036 and k == 0:
            message = SetDoor(name=self._doors[int(u[1] * len(self._doors))], open=bool(u[2] < 0.5))
        return message

    def take_in(self) -> None:
        """Add what everyone was sent to the digests."""
        for session, digest in zip(self.sessions, self.digests, strict=True):
            kept = cast(KeptConnection, session._connection)  # noqa: SLF001 - made in `_come`
            for payload in _payloads(b"".join(kept.frames)):
                if payload[0] != 0x92 or payload[1] not in LEFT_OUT:
                    digest.update(payload)
            kept.frames.clear()

    def digest(self) -> str:
        """One digest of all."""
        return hashlib.sha256("".join(d.hexdigest() for d in self.digests).encode()).hexdigest()


def _payloads(written: bytes) -> Iterator[bytes]:
    """The payload of each frame; a client that reads cannot tell how they were written."""
    at = 0
    while at < len(written):
        size, begin = written[at + 1] & 127, at + 2
        if size >= 126:
            begin += 2 if size == 126 else 8
            size = int.from_bytes(written[at + 2 : begin])
        at = begin + size
        yield written[begin:at]


async def run(ticks: int, clients: int) -> str:
    """The digest after so many ticks with so many clients."""
    settings = ServerSettings(**SETTINGS)  # type: ignore[arg-type]
    with ThreadPoolExecutor(1) as routes, progress() as shown:
        population, world, storeys = build_world(load_scene(settings), settings)
        # Ticks run faster than the clock by which searches are limited.
        requests = RouteRequests(world, routes, SearchBudget(Share(1e9, 1e9), Share(1e9, 1e9)))
        audience = Audience(world.rules, world.origin_m, world.times)
        hub = Hub(
            world,
            audience,
            requests,
            settings,
            Metrics(),
            lambda: world.tick * world.tick_s,
            {"storeys": storeys},
            ModerationState(cast(Store, None)),
        )
        delivery = Delivery(audience, hub.sessions, settings.tick_rate, hub.wishes.stop_watching)
        visitors = Visitors(hub, world, settings, clients)
        finding = asyncio.create_task(requests.run(hub.wishes.route_found))
        for tick in shown.track(range(ticks), description="ticks"):
            now = tick * world.tick_s
            visitors.act(tick)
            # A route that is asked for in a tick is found before its end, so that runs are alike.
            while requests.waiting:  # noqa: ASYNC110 - the requests tell nobody when they are done
                await asyncio.sleep(0.0002)
            world.begin(hub.drain(now))
            frame = world.finish(world.think())
            hub.welcome(frame)
            delivery.deliver(audience.take(frame), now)
            visitors.take_in()
        finding.cancel()
        population.close()
    return visitors.digest()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--ticks", type=int, default=2000, help="ticks to run [2000]")
    parser.add_argument("--clients", type=int, default=50, help="people who are there [50]")
    options = parser.parse_args()
    print(asyncio.run(run(options.ticks, options.clients)))


if __name__ == "__main__":
    main()
