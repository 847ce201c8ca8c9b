"""The error of checkpoints that a world cannot go on from."""

from typing import Final

from esplanade.server.store.store import StoreError

WHAT_HELPS: Final = (
    "start with --fresh to begin the world anew (accounts and the audit stay), or restore a copy "
    "into a new folder with `esplanade data restore`"
)


class CheckpointError(StoreError):
    """A checkpoint that cannot be used; the message says why and what to do."""
