"""XML: trajectories of JPScore, and boxes around people in films, as of PETS and ETH-Person."""

from collections.abc import Callable
from pathlib import Path
from typing import Final
from xml.parsers import expat

import numpy as np

from esplanade.recordings.errors import RecordingError
from esplanade.recordings.rows import Rows, number, people
from esplanade.recordings.units import PIXELS

MOST_IDLE: Final = 20_000
"""A file with more elements than this and no person in them is of something else."""
_FRAMES_A_SECOND: Final = {"dataset": (7.0, "as PETS has")}
"""By the root of the annotations."""


def read_xml(path: Path, text: str) -> Rows:
    """Read the samples of a film's annotations, or of JPScore; document types are refused.

    Raises
    ------
    RecordingError
        It is none of these.
    """
    reader = _Reader(path)
    parser = expat.ParserCreate("utf-8")
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.CharacterDataHandler = reader.text
    parser.StartDoctypeDeclHandler = reader.refuse_doctype
    content = text.lstrip()
    above = text.count("\n", 0, len(text) - len(content))
    reader.line = lambda: parser.CurrentLineNumber + above
    try:
        # The text is decoded already, whatever its declaration says of an encoding.
        parser.Parse(content.encode("utf-8", errors="replace"), True)
    except expat.ExpatError as error:
        raise RecordingError(path, f"is no XML that can be read: {error}"[:200]) from None
    return reader.rows()


class _Reader:
    """The state of reading up to an element."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.line: Callable[[], int] = lambda: 0
        self._root = ""
        self._frame: float | None = None
        self._who = ""
        self._open = ""
        self._rate = ""
        self._names: list[str] = []
        self._lines: list[int] = []
        self._samples: list[tuple[float, float, float]] = []
        self._boxes = False
        self._idle = 0

    def start(self, tag: str, has: dict[str, str]) -> None:
        """Take in the beginning of an element."""
        self._root = self._root or tag
        self._idle += 1
        if self._idle > MOST_IDLE:
            raise RecordingError(
                self.path, f"is XML with the root <{self._root:.40}> and without people"
            )
        self._open = tag
        match tag:
            case "frame" if has:
                self._frame = self._number(has, "number" if "number" in has else "ID")
            case "object" if self._frame is not None:
                self._who = has.get("id", "")
            case "box" if self._frame is not None and "xc" in has:
                self._boxes = True
                foot = self._number(has, "yc") + 0.5 * self._number(has, "h")
                self._add(self._who, self._number(has, "xc"), -foot)
            case "agent" if self._frame is not None:
                self._add(has.get("ID", ""), self._number(has, "x"), self._number(has, "y"))

    def end(self, tag: str) -> None:
        """Take in the end of an element."""
        self._open = ""
        if tag == "frame":
            self._frame = None

    def text(self, text: str) -> None:
        """Take in text, which is the rate of frames."""
        if self._open == "frameRate" and len(self._rate) < 40:
            self._rate += text.strip()

    def refuse_doctype(self, *_: object) -> None:
        """Refuse what could define entities."""
        raise RecordingError(self.path, "its XML declares a document type, which is not read")

    def rows(self) -> Rows:
        """All samples."""
        if not self._samples:
            raise RecordingError(
                self.path,
                f"is XML with the root <{self._root:.40}> and without people: frames with objects "
                "and boxes (PETS), or with agents (JPScore), are read",
            )
        ids, who = people(self._names)
        block = np.array(self._samples, np.float64)
        usual = _FRAMES_A_SECOND.get(self._root) if self._boxes else None
        fps = number(self.path, 1, "frameRate", self._rate) if self._rate else None
        if fps is not None and not 0.0 < fps < 1e6:
            raise RecordingError(self.path, f"frameRate is {fps:g}, expected more than 0")
        return Rows(
            format="boxes in a film, as XML" if self._boxes else "JPScore XML",
            lines=np.array(self._lines, np.int64),
            ids=ids,
            who=who,
            clock=block[:, 0],
            x=block[:, 1],
            y=block[:, 2],
            counts_frames=True,
            fps=fps,
            usual_fps=usual[0] if usual else None,
            usual_from=usual[1] if usual else "",
            unit=PIXELS if self._boxes else "m",
            unit_from="as its form has it",
        )

    def _add(self, name: str, x: float, y: float) -> None:
        if not name:
            raise RecordingError(self.path, "a person has no id", self.line())
        self._idle = 0
        self._names.append(name)
        self._lines.append(self.line())
        self._samples.append((self._frame or 0.0, x, y))

    def _number(self, has: dict[str, str], key: str) -> float:
        return number(self.path, self.line(), key, has.get(key, ""))
