"""The parts of a checkpoint: each saves itself as plain data, and is given it back at the start."""

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from esplanade.server.checkpoint.errors import WHAT_HELPS, CheckpointError

Result = TypeVar("Result")


class Parts:
    """The parts of one world, by their names.

    `save` of a part is called between two ticks and must be cheap: it copies what later ticks
    change, and leaves the packing to others. What it returns is numbers, text, bytes, lists,
    mappings and arrays, and names nobody: names of people stand in tables that forget them.
    """

    def __init__(self, restored: Mapping[str, Any] | None = None) -> None:
        """`restored` is what the parts saved before the restart; None where the world is new."""
        self.restored = restored
        self._savers: dict[str, Callable[[], Any]] = {}

    def part(
        self, name: str, save: Callable[[], Any], load: Callable[[Any], None] | None = None
    ) -> None:
        """Register a part. If the checkpoint has data of it, `load` is given them at once.

        Raises
        ------
        CheckpointError
            The data are not what `load` can take.
        ValueError
            The name is taken.
        """
        if name in self._savers:
            raise ValueError(f"there already is a part {name!r}")
        self._savers[name] = save
        if load is not None and self.restored is not None and name in self.restored:
            with_faults_told(name, load, self.restored[name])

    def save(self) -> dict[str, Any]:
        """The states of all parts at this moment, by their names."""
        return {name: save() for name, save in self._savers.items()}


def with_faults_told(name: str, load: Callable[[Any], Result], data: Any) -> Result:
    """The result of loading a part.

    Raises
    ------
    CheckpointError
        The data are not what `load` can take.
    """
    try:
        return load(data)
    except Exception as error:
        why = f"{type(error).__name__}: {error}"
        raise CheckpointError(
            f"the part {name!r} of the checkpoint cannot be read ({why}): {WHAT_HELPS}"
        ) from error
