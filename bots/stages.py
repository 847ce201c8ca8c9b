"""Stages of a load test: how many bots are to be in the world, over time."""

import re
from typing import Final, NamedTuple

MAX_STAGES: Final = 100
MAX_BOTS: Final = 10_000
MAX_DURATION_S: Final = 1e6

_STAGE: Final = re.compile(r"(\d+(?:\.\d+)?)(ms|s|m|h):(\d+)")
_UNITS_S: Final = {"ms": 1e-3, "s": 1.0, "m": 60.0, "h": 3600.0}


class Stage(NamedTuple):
    """Over this time, the number of those who are in the world goes evenly to `bots`."""

    duration_s: float
    bots: int


class Stay(NamedTuple):
    """A bot is to be in the world from one time to another, seconds from the beginning."""

    begin_s: float
    end_s: float


def read_stages(text: str) -> tuple[Stage, ...]:
    """Stages as people write them, like `30s:100,1m:500,30s:0`.

    Raises
    ------
    ValueError
        The text means no stages, nobody would ever come, or there are too many of something.
    """
    stages = []
    for word in text.replace(" ", "").split(","):
        found = _STAGE.fullmatch(word)
        if found is None:
            raise ValueError(f"{word!r} is no stage, expected TIME:BOTS like 30s:100 or 1.5m:0")
        duration_s = float(found[1]) * _UNITS_S[found[2]]
        stages.append(Stage(duration_s, int(found[3])))
    if len(stages) > MAX_STAGES:
        raise ValueError(f"there may be {MAX_STAGES} stages, not {len(stages)}")
    most = max(stage.bots for stage in stages)
    if most > MAX_BOTS:
        raise ValueError(f"there may be {MAX_BOTS} bots at once, not {most}")
    if most == 0:
        raise ValueError("no stage has any bots")
    total_s = sum(stage.duration_s for stage in stages)
    if not 0.0 < total_s <= MAX_DURATION_S:
        raise ValueError(f"all stages together last {total_s:g} s, expected up to 1000000 s")
    return tuple(stages)


def stays(stages: tuple[Stage, ...], index: int) -> list[Stay]:
    """The times when bot number `index` is in the world; the last that came goes first."""
    found: list[Stay] = []
    wanted = index + 1
    now_s, count, begin_s = 0.0, 0, None
    for stage in stages:
        end_s = now_s + stage.duration_s
        rises = count < wanted <= stage.bots
        falls = stage.bots < wanted <= count
        if rises or falls:
            # A bot goes as soon as fewer are wanted than it needs, and comes once it is wanted.
            crossed = wanted - count if rises else count - wanted
            at_s = min(end_s, now_s + stage.duration_s * crossed / abs(stage.bots - count))
            if rises:
                begin_s = at_s
            elif begin_s is not None:
                found.append(Stay(begin_s, at_s))
                begin_s = None
        now_s, count = end_s, stage.bots
    if begin_s is not None:
        found.append(Stay(begin_s, now_s))
    return found
