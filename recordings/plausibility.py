"""What a recording says of itself in one line, and what of it cannot be meant."""

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from esplanade.recordings.glitches import FASTEST_MPS
from esplanade.recordings.rates import WALKING_MPS, likely_rates

_FACTORS: Final = {"cm": 0.01, "mm": 0.001, "ft": 0.3048, "km": 1000.0}
_MANY_GLITCHES: Final = 0.05
_FEW_GLITCHES: Final = 3


@dataclass(frozen=True)
class Report:
    """The figures of a recording as it was read."""

    format: str
    people: int
    samples: int
    seconds: float
    sample_s: float
    """The most common time between two samples of a person; 0 if nobody has two."""
    median_mps: float
    """The median speed over all steps; NaN if there are none."""
    greatest_mps: float
    passed_over: int
    """Glitches, which are not among the samples."""
    rate: str
    unit: str
    remarks: tuple[str, ...] = ()
    warnings: tuple[str, ...] = field(default=())

    @property
    def share_passed_over(self) -> float:
        """The share of samples that were passed over, from 0 to 1."""
        return self.passed_over / max(1, self.samples + self.passed_over)

    @property
    def line(self) -> str:
        """All figures in one line."""
        count = f"{self.people} {'person' if self.people == 1 else 'people'}"
        if self.sample_s > 0.0:
            pace = (
                f"{self.sample_s:.4g} s a sample, median {self.median_mps:.3g} m/s, "
                f"greatest {self.greatest_mps:.3g} m/s"
            )
        else:
            pace = "nobody with two samples"
        share = f"{100.0 * self.share_passed_over:.2g} % of samples passed over"
        if self.passed_over:
            share = f"{share} ({self.passed_over} glitch{'es' if self.passed_over > 1 else ''})"
        source = f"{self.format}, {self.rate}, {self.unit}"
        return f"{count}, {self.seconds:.6g} s, {pace}, {share}; {source}"


def beyond_meaning(median_mps: float) -> bool:
    """Whether nobody can be as fast as half of the steps are."""
    return bool(median_mps > FASTEST_MPS)


def advice(median_mps: float, fps: float, *, unit_known: bool, rate_known: bool) -> str:
    """Which options would put a median speed right, with what it would be then.

    `fps` is the number of frames a second that were taken for it.
    """
    options = []
    if not unit_known:
        fitting = [
            f"--unit {unit} ({median_mps * metres:.3g} m/s)"
            for unit, metres in _FACTORS.items()
            if WALKING_MPS[0] <= median_mps * metres <= WALKING_MPS[1]
        ]
        options += fitting or ["--unit if its unit is not the metre"]
        options.append("--scale if its unit is the pixel")
    if not rate_known:
        rates = likely_rates(median_mps / fps) if fps else ()
        options += [f"--fps {rate:g} ({median_mps * rate / fps:.3g} m/s)" for rate in rates[:4]]
        options += [] if rates else ["--fps if there are other frames a second"]
    if not options:
        return "if what the file says itself is wrong, give --fps, --unit or --scale"
    return f"give {', '.join(options)}"


def warnings_of(
    median_mps: float,
    fps: float,
    glitches: int,
    passed_over: float,
    *,
    unit_known: bool,
    rate_known: bool,
    times_known: bool,
) -> tuple[str, ...]:
    """What is not as recordings of people are."""
    found = []
    if np.isnan(median_mps):
        found.append("nobody has two samples: nothing shows that these are people who walk")
    if not np.isnan(median_mps) and not WALKING_MPS[0] <= median_mps <= WALKING_MPS[1]:
        told = advice(median_mps, fps, unit_known=unit_known, rate_known=rate_known)
        if not times_known and WALKING_MPS[0] <= 1e3 * median_mps <= WALKING_MPS[1]:
            told = (
                f"were its times milliseconds, people would walk at {1e3 * median_mps:.3g} m/s: "
                "name that column t_ms, or give --columns, as in --columns t=NAME/ms,id=NAME,.."
            )
        found.append(
            f"the median speed is {median_mps:.3g} m/s, people walk at {WALKING_MPS[0]} to "
            f"{WALKING_MPS[1]} m/s; {told}"
        )
    if passed_over > _MANY_GLITCHES and glitches >= _FEW_GLITCHES:
        share = f"{100.0 * passed_over:.2g} % of the samples"
        found.append(f"{share} are glitches: are --fps and --unit right?")
    return tuple(found)
