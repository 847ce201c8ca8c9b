"""People whose avatars are walked to a place of arrival, where they leave."""

import math
from collections.abc import Callable, Mapping, Set
from dataclasses import dataclass
from typing import Final

import structlog

from esplanade.protocol import ProtocolError
from esplanade.protocol.messages import WalkTo
from esplanade.server.moderation.areas import Place
from esplanade.server.net.fair_queue import Asker
from esplanade.server.net.guests import Guest
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.world.inputs import Follow
from esplanade.server.world.routes import Route
from esplanade.server.world.zone import Zone

LONGEST_S: Final = 90.0
"""Who has not arrived after this time leaves from where they are."""
ARRIVED_M: Final = 1.0

log = structlog.get_logger(__name__)


@dataclass(slots=True)
class _WalkOut:
    text: str
    until_s: float
    goal: Place
    begun: bool = False


class WalkOuts:
    """Walks people out; what they send to move is void meanwhile."""

    def __init__(
        self,
        world: Zone,
        sessions: Mapping[int, Guest],
        routes: RouteRequests,
        follow: Callable[[Follow], None],
        leave: Callable[[int, str], None],
    ) -> None:
        """`follow` takes a movement for the next tick, `leave` lets a person go with a text."""
        self._world = world
        self._sessions = sessions
        self._routes = routes
        self._follow = follow
        self._leave = leave
        self._under_way: dict[int, _WalkOut] = {}

    def __len__(self) -> int:
        return len(self._under_way)

    def __contains__(self, avatar_id: int | None) -> bool:
        return avatar_id in self._under_way

    def among(self, avatar_ids: Set[int]) -> Set[int]:
        """Those of some people who are walked out."""
        return self._under_way.keys() & avatar_ids

    def way_out(self, avatar_id: int) -> Place | None:
        """The place of arrival that is nearest to an avatar; None where the scene has none."""
        state = self._world.state
        slot = state.slot(avatar_id)
        place = (*state.positions[slot].tolist(), float(state.heights[slot]))
        spawns = [(*spawn.position, spawn.z_m) for spawn in self._world.scene.spawns]
        return min(spawns, key=lambda spawn: math.dist(spawn, place), default=None)

    def begin(self, session: Guest, text: str, goal: Place, now_s: float) -> None:
        """Walk somebody out to that place."""
        avatar_id = session.avatar_id
        if avatar_id is None:
            return
        self._under_way[avatar_id] = _WalkOut(text, now_s + LONGEST_S, goal)
        x, y, z = goal
        try:
            asker = Asker(session.address, avatar_id)
            self._routes.ask(asker, WalkTo(seq=session.last_seq, x=x, y=y, z=z))
        except ProtocolError:
            # This person has had too many routes sought; nobody waits for that.
            self._end(avatar_id)

    def route_found(self, avatar_id: int, route: Route | None) -> None:
        """Send somebody along their way out; without one they leave at once."""
        if route is None:
            self._end(avatar_id)
            return
        self._under_way[avatar_id].begun = True
        # It counts as a movement of the client, which learns of it by a notice.
        self._follow(Follow(avatar_id, self._sessions[avatar_id].last_seq + 1, route))

    def forget(self, avatar_id: int) -> None:
        """Somebody has gone by themselves."""
        self._under_way.pop(avatar_id, None)

    def check(self, now_s: float) -> None:
        """Let those go who have arrived, or are on their way for too long; call it each tick."""
        for avatar_id, walk in list(self._under_way.items()):
            if avatar_id not in self._sessions:
                self.forget(avatar_id)
            elif now_s > walk.until_s or (walk.begun and self._arrived(avatar_id, walk)):
                self._end(avatar_id)

    def _arrived(self, avatar_id: int, walk: _WalkOut) -> bool:
        state = self._world.state
        if avatar_id not in state:
            return True
        slot = state.slot(avatar_id)
        return (
            math.dist(state.positions[slot].tolist(), walk.goal[:2]) < ARRIVED_M
            and abs(float(state.heights[slot]) - walk.goal[2]) < ARRIVED_M
        )

    def _end(self, avatar_id: int) -> None:
        walk = self._under_way.pop(avatar_id)
        if avatar_id in self._sessions:
            self._leave(avatar_id, walk.text)
            log.info("person walked out", id=avatar_id)
