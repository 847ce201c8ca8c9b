"""Faults of what is asked for."""


class WhatIfError(ValueError):
    """A change cannot be made, or the stretch is empty; the message says why."""
