"""Cells of tables: numbers, and numbers with their intervals."""

import math

from esplanade.stats import Interval


def number(value: float, digits: int, sign: str = "") -> str:
    """A number with so many digits after the decimal point; `sign` may be +."""
    return f"{value:{sign}.{digits}f}" if math.isfinite(value) else "–"


def with_interval(value: float, interval: Interval, digits: int, sign: str = "") -> str:
    """A number and the bounds of its interval."""
    low, high = (number(bound, digits, sign) for bound in interval)
    return f"{number(value, digits, sign)} ({low} to {high})"
