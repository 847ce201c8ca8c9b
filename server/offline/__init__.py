"""A world without a server: as fast as the machine can, from a command or a few lines of Python."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from esplanade.server.offline.world import OfflineWorld

__all__ = ["OfflineWorld"]


def __getattr__(name: str) -> Any:
    """The world, imported once it is wanted: the options beside it load nothing heavy."""
    if name != "OfflineWorld":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from esplanade.server.offline.world import OfflineWorld  # noqa: PLC0415

    return OfflineWorld
