"""Operators begin recordings of a world, and end them."""

from typing import Any, Final, Protocol

from esplanade.protocol.commands import CommandFault
from esplanade.server.recording.errors import NotRecordedError

RECORDING: Final = "recording"
"""The subject that the recording of the world is."""
RECORDED: Final = "recorded"
"""Its field: whether the world is recorded."""


class Recorder(Protocol):
    """The part of a server that writes the recordings of a world."""

    @property
    def is_on(self) -> bool:
        """Whether the world is being recorded."""

    async def switch(self, *, on: bool) -> None:
        """Begin a recording, or end the one there is; nothing if it is so already.

        Raises
        ------
        NotRecordedError
            No file can be written.
        """

    def told(self) -> dict[str, Any]:
        """The state of the recording, for programs."""


async def switched(recorder: Recorder, *, on: bool) -> list[CommandFault]:
    """Begin or end a recording; the fault, if it cannot be."""
    try:
        await recorder.switch(on=on)
    except NotRecordedError as error:
        return [CommandFault(code="not_recorded", text=str(error))]
    return []
