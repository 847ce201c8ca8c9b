"""Welcome messages, the first that a client gets; the scene in them is packed once for all."""

from collections.abc import Callable, Mapping

import msgpack

from esplanade.planning.grid.grid import ADULT
from esplanade.protocol import ServerCode
from esplanade.protocol.messages import Welcome
from esplanade.server.net import frames
from esplanade.server.net.session import Session
from esplanade.server.settings import ServerSettings
from esplanade.server.world.zone import Zone


class Welcomes:
    """Welcomes people to a zone. The scene goes out with what was `derived` from it."""

    def __init__(
        self,
        world: Zone,
        settings: ServerSettings,
        server_time: Callable[[], float],
        derived: Mapping[str, object],
    ) -> None:
        self._world = world
        self._settings = settings
        self._server_time = server_time
        scene = world.scene.model_dump(mode="json", exclude={"mesh", "portals"})
        self._scene: bytes = msgpack.packb({**scene, **derived})

    def frame(self, session: Session, avatar_id: int, resumed: bool) -> bytes:
        """The welcome of a session that has this avatar from now on, as a frame."""
        return with_scene(self._welcome(session, avatar_id, resumed), self._scene)

    def _welcome(self, session: Session, avatar_id: int, resumed: bool) -> Welcome:
        world, settings, rules = self._world, self._settings, self._world.rules
        return Welcome(
            version=session.version,
            id=avatar_id,
            name=session.name,
            resume=session.token,
            resumed=resumed,
            scene={},
            tick=world.tick,
            tick_rate=settings.tick_rate,
            server_time=self._server_time(),
            resume_seconds=settings.resume_seconds,
            radius=rules.person_radius_m,
            clearance=rules.person_clearance_m,
            body_height=ADULT.height_m,
            step_height=ADULT.step_on_m,
            max_speed=rules.person_max_speed_mps,
            walk_speed=min(rules.person_walk_speed_mps, rules.person_max_speed_mps),
            origin=world.origin_m,
            doors=world.doors.states(),
            operator=session.is_operator,
        )


def with_scene(welcome: Welcome, scene: bytes) -> bytes:
    """The frame of a welcome, with the packed scene in place of the one that it holds."""
    fields = welcome.model_dump(mode="json", exclude={"scene"})
    packer = msgpack.Packer(autoreset=False)
    packer.pack_array_header(2)
    packer.pack(int(ServerCode.WELCOME))
    packer.pack_map_header(len(fields) + 1)
    for name, value in fields.items():
        packer.pack(name)
        packer.pack(value)
    packer.pack("scene")
    return frames.frame(packer.bytes() + scene)
