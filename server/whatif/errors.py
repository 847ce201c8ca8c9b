"""Faults of what is asked for."""


class WhatIfError(ValueError):
    """What is to be changed cannot be, or the stretch is empty; the message says why."""
