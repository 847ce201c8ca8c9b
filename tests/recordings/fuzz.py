"""Mutations of files, and what must hold of a recording that was read; see `tests.files.fuzz`.

Whatever is done to a file, reading it ends soon, in a crowd or in a `RecordingError`. A crowd is
held against checks of its own: nothing is accepted without a word that they would warn of.
"""

import gzip
import random
import time
from pathlib import Path

import numpy as np

from esplanade.recordings import Crowd, RecordingError, read_crowd
from tests.recordings.forms import Form

SOON_S = 5.0
WORDS = (
    *(
        b"nan",
        b"inf",
        b"-inf",
        b"1e999",
        b"1e300",
        b"-0",
        b"",
        b"?",
        b"\0",
        b"1_0",
        b"0x10",
        b"\xff",
    ),
    *(b"9" * 400, b"99999999999999999999", b"2.5.1", b"1,5", b"'", b'"', b"#", b"\xef\xbb\xbf"),
    *(b";", b"\t", b",", b" ", b"\n", b"\r", b"\r\n", b"{}", b"[", b"-", b"t,id,x,y\n", b"fps 0\n"),
    *("٣".encode(), "½".encode(), b"true", b"null", b"1e5", b"0.0001", b"60", b"frame", b"x/cm"),
)


def mutated(content: bytes, chance: random.Random) -> bytes:
    """The content with one to four things done to it."""
    packed = content.startswith(b"\x1f\x8b") and chance.random() < 0.7
    found = bytearray(gzip.decompress(content) if packed else content)
    for _ in range(chance.choice((1, 1, 1, 2, 3, 4))):
        _mutate(found, chance)
    return gzip.compress(bytes(found), 1) if packed else bytes(found)


def _mutate(found: bytearray, chance: random.Random) -> None:
    at = chance.randrange(len(found) + 1)
    to = min(len(found), at + chance.choice((1, 1, 2, 4, 9, 40)))
    match chance.randrange(9):
        case 0:
            del found[at:to]
        case 1:
            found[at:at] = chance.choice(WORDS)
        case 2:
            found[at:to] = chance.choice(WORDS)
        case 3 if found:
            found[min(at, len(found) - 1)] = chance.randrange(256)
        case 4:
            found[at:at] = found[at:to] * chance.choice((1, 2, 30))
        case 5:
            del found[at:]
        case 6:
            _mutate_rows(found, chance)
        case 7:
            _mutate_cell(found, chance)
        case _:
            digits = [i for i, byte in enumerate(found) if 48 <= byte < 58]
            if digits:
                found[chance.choice(digits)] = chance.randrange(48, 58)


def _mutate_rows(found: bytearray, chance: random.Random) -> None:
    rows = bytes(found).split(b"\n")
    one, other = chance.randrange(len(rows)), chance.randrange(len(rows))
    if chance.random() < 0.5:
        rows[one], rows[other] = rows[other], rows[one]
    elif chance.random() < 0.5:
        rows.insert(one, rows[other])
    else:
        chance.shuffle(rows)
    found[:] = b"\n".join(rows)


def _mutate_cell(found: bytearray, chance: random.Random) -> None:
    """Another value in the place of a cell: a number that is not meant, or a word."""
    rows = bytes(found).split(b"\n")
    place = chance.randrange(len(rows))
    cells = rows[place].split()
    separator = b" "
    for mark in (b",", b";", b"\t"):
        if mark in rows[place]:
            cells, separator = rows[place].split(mark), mark
    if cells:
        cells[chance.randrange(len(cells))] = chance.choice(
            (*WORDS, b"%.3f" % chance.uniform(-100.0, 100.0), b"%d" % chance.randrange(-9, 2000))
        )
    rows[place] = separator.join(cells)
    found[:] = b"\n".join(rows)


def fault_of(crowd: Crowd) -> str | None:
    """The fault of a crowd that was accepted."""
    report = crowd.report
    if report is None or not crowd.tracks:
        return "nothing is told of it"
    speeds = []
    for track in crowd.tracks:
        if not (np.isfinite(track.times).all() and np.isfinite(track.positions).all()):
            return f"{track.id} is somewhere that is no place"
        gaps = np.diff(track.times)
        if not (gaps > 0.0).all():
            return f"{track.id} goes back in time"
        if np.abs(track.positions).max() > 1e5 or np.abs(track.times).max() > 1e10:
            return f"{track.id} is out of range"
        speeds.append(np.hypot(*np.diff(track.positions, axis=0).T) / gaps)
    every = np.concatenate(speeds)
    if len({track.id for track in crowd.tracks}) != len(crowd.tracks):
        return "two people have the same id"
    if not len(every):
        return None
    if every.max() > 12.5 + 1e-9:
        return f"somebody moves at {every.max():.1f} m/s"
    if not 0.3 <= np.median(every) <= 2.5 and not report.warnings:
        return f"a median of {np.median(every):.3g} m/s is not warned of"
    return None


def tried(path: Path, form: Form, content: bytes) -> str:
    """How reading went: accepted, odd, refused.

    Raises
    ------
    AssertionError
        It took too long, or a crowd was accepted that should not be.
    """
    path.write_bytes(content)
    began = time.process_time()
    try:
        crowd = read_crowd(path, **form.given)
    except RecordingError as error:
        outcome, said = "refused", str(error)
    else:
        fault = fault_of(crowd)
        assert fault is None, fault
        outcome = "odd" if crowd.report and crowd.report.warnings else "accepted"
        said = str(path)
    took_s = time.process_time() - began
    assert took_s < SOON_S, f"{took_s:.1f} s"
    assert str(path) in said
    assert len(said) < 900, said[:2000]
    return outcome
