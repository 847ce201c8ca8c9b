"""How recordings are laid out in MCAP: names of what stands in them, and a chunk a second."""

import json
from typing import IO, Any, Final

from mcap.writer import CompressionType, Writer

PROFILE: Final = "esplanade"
"""The name of this kind of file, in the header of each recording."""
ABOUT: Final = "esplanade recording"
"""The name of the record of metadata that says what made a file."""
WRITTEN_BY: Final = "written by"
"""The name in these metadata of the program and its version."""
SCENE: Final = "scene.json"
SETTINGS: Final = "settings.json"
INPUTS: Final = "inputs"
DIGESTS: Final = "digests"
CHECKPOINTS: Final = "checkpoints"
COMMANDS: Final = "commands"
EVENTS: Final = "events"
_CHUNK_BYTES: Final = 2**40
"""Chunks end by `end_chunk`, and never by their size."""


def begun_writer(file: IO[bytes], written_by: str) -> Writer:
    """A writer to which the head and then the seconds of a recording are given."""
    writer = Writer(file, _CHUNK_BYTES, CompressionType.ZSTD)
    writer.start(profile=PROFILE, library=written_by)
    return writer


def end_chunk(writer: Writer) -> None:
    """End the chunk that is being filled, which the library does by the size of chunks alone."""
    writer._Writer__finalize_chunk()  # type: ignore[attr-defined]  # noqa: SLF001


def to_json(message: Any) -> bytes:
    """A message as JSON; numbers come back as they are, bit for bit."""
    return json.dumps(message, separators=(",", ":"), ensure_ascii=False).encode()
