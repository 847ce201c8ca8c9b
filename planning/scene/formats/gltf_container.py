"""The container of glTF: the JSON of a file, and the bytes of its buffers, within bounds."""

from __future__ import annotations

import base64
import binascii
import json
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote, unquote_to_bytes

from esplanade.files.text import decoded

MAX_BYTES: Final = 512 * 2**20
"""Most bytes of all buffers together."""
MAX_VALUES: Final = 3_000_000
"""Most values in its JSON: reading them takes a microsecond and a hundred bytes for each."""
_MAGIC: Final = b"glTF"
_JSON, _BIN = 0x4E4F534A, 0x004E4942


class Container:
    """A glTF file that is open: its content, and its buffers one by one.

    Raises
    ------
    ValueError
        It is no glTF 2.0, or larger than may be.
    """

    def __init__(self, path: Path, data: bytes) -> None:
        self._folder = path.parent
        text, self._binary = _chunks(data) if data.startswith(_MAGIC) else (data, None)
        if text.count(b",") + text.count(b"[") + text.count(b"{") > MAX_VALUES:
            raise ValueError(f"its JSON has more than {MAX_VALUES} values")
        try:
            # Some programs fill the JSON of a binary file with zeros.
            content = json.loads(decoded(text).text)
        except RecursionError:
            raise ValueError("its JSON is too deep") from None
        except ValueError as error:
            raise ValueError(f"its JSON is none: {error}") from None
        if not isinstance(content, dict) or not isinstance(content.get("asset"), dict):
            raise ValueError("it is no glTF: it names no asset")  # noqa: TRY004
        version = str(content["asset"].get("version"))
        if not version.startswith("2."):
            raise ValueError(f"it is glTF {version}; glTF 2.0 is read")
        least = content["asset"].get("minVersion", "2.0")
        if least != "2.0":
            raise ValueError(f"it needs a reader of glTF {least!r:.20}; glTF 2.0 is read")
        self.content: dict[str, Any] = content
        self._buffers: dict[int, bytes] = {}
        self._read = 0

    def objects(self, key: str) -> list[Any]:
        """A list of the content, empty where it has none."""
        found = self.content.get(key, [])
        if not isinstance(found, list) or not all(isinstance(part, dict) for part in found):
            raise ValueError(f"its {key} are no list of objects")
        return found

    def part(self, key: str, index: Any) -> Any:
        """An object of a list of the content; ValueError where there is none of this number."""
        parts = self.objects(key)
        if type(index) is not int or not 0 <= index < len(parts):
            raise ValueError(f"it names {key} {index!r}, and there are {len(parts)}")
        return parts[index]

    def buffer(self, index: Any) -> bytes:
        """The bytes of a buffer."""
        described = self.part("buffers", index)
        if index not in self._buffers:
            found = self._bytes_of(index, described.get("uri"))
            length = described.get("byteLength")
            if type(length) is not int or not 0 <= length <= len(found):
                raise ValueError(
                    f"buffer {index} should have {length!r} bytes, and has {len(found)}"
                )
            self._read += len(found)
            if self._read > MAX_BYTES:
                raise ValueError(f"its buffers have more than {MAX_BYTES // 2**20} MiB")
            self._buffers[index] = found
        return self._buffers[index]

    def _bytes_of(self, index: int, address: Any) -> bytes:
        if address is None:
            if index or self._binary is None:
                raise ValueError(f"buffer {index} is nowhere")
            return self._binary
        if not isinstance(address, str):
            raise ValueError(f"the address of buffer {index} is no text")  # noqa: TRY004
        if address.startswith("data:"):
            head, _, body = address.partition(",")
            if not head.endswith(";base64"):
                return unquote_to_bytes(body)
            try:
                return base64.b64decode(unquote_to_bytes(body), validate=True)
            except binascii.Error as error:
                raise ValueError(f"buffer {index} is no base64: {error}") from None
        file = self._beside(address)
        if file.stat().st_size > MAX_BYTES:
            raise ValueError(f"its buffers have more than {MAX_BYTES // 2**20} MiB")
        return file.read_bytes()

    def _beside(self, address: str) -> Path:
        """The file of a buffer: by its percent-decoded name, or by the very name where that is
        none."""
        for name in (unquote(address), address):
            if "\0" not in name and "://" not in name:
                file = self._folder / name
                if file.is_file():
                    return file
        raise ValueError(f"there is no file {unquote(address)!r} beside it, a buffer of it")


def _chunks(data: bytes) -> tuple[bytes, bytes | None]:
    """The JSON and the binary chunk of a GLB file."""
    version = int.from_bytes(data[4:8], "little")
    length = int.from_bytes(data[8:12], "little")
    if version != 2:
        raise ValueError(f"it is binary glTF {version}; glTF 2.0 is read")
    if length > len(data):
        raise ValueError(f"it should have {length} bytes, and has {len(data)}")
    found: dict[int, bytes] = {}
    place = 12
    while place + 8 <= length:
        size = int.from_bytes(data[place : place + 4], "little")
        kind = int.from_bytes(data[place + 4 : place + 8], "little")
        if place + 8 + size > length:
            raise ValueError("a chunk of it goes beyond its end")
        found.setdefault(kind, data[place + 8 : place + 8 + size])
        place += 8 + size
    if _JSON not in found:
        raise ValueError("it has no JSON")
    return found[_JSON], found.get(_BIN)
