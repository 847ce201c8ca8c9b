"""Meshes of a cluster's scenes as a gateway hands them to browsers."""

import asyncio
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import structlog

from esplanade.planning.scene.world_file import WorldError, read_world
from esplanade.server.assets import Assets
from esplanade.server.cluster.world_rows import write_files
from esplanade.server.loading import LoadingError, mesh_triangles
from esplanade.server.store.store import Store, StoreError

log = structlog.get_logger(__name__)


class Meshes:
    """Adds the triangles of the scenes in the database to the assets of a gateway."""

    def __init__(self, store: Store, assets: Assets) -> None:
        self._store = store
        self._assets = assets

    async def provide(self, address: str | None) -> None:
        """See to it that browsers get the mesh that a host tells them of.

        Without it they would show people who walk on nothing, but could walk too; so that nobody
        is kept out.
        """
        if address is None or self._assets.has(address):
            return
        try:
            await self.read()
        except (StoreError, WorldError, LoadingError, OSError) as error:
            log.warning("meshes cannot be read", why=str(error))
        if not self._assets.has(address):
            log.warning("a mesh is not that of the world in the database", address=address)

    async def read(self) -> None:
        """Read the meshes of all scenes.

        Raises
        ------
        StoreError
            The database does not answer, or has no world yet.
        WorldError, LoadingError, OSError
            The world cannot be read.
        """
        with tempfile.TemporaryDirectory(prefix="esplanade-world-") as folder:
            path = await self._store.read(partial(_write_files, Path(folder)))
            for triangles in await asyncio.to_thread(_triangles_in, path):
                self._assets.add_mesh(triangles)


def _triangles_in(path: Path) -> list[bytes]:
    scenes = read_world(path).scenes.values()
    meshes = {scene.mesh for scene in scenes if scene.mesh is not None}
    return [mesh_triangles(mesh) for mesh in sorted(meshes)]


def _write_files(folder: Path, connection: Any) -> Path:
    return write_files(connection, folder)
