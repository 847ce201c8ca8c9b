"""Connections of people are bounded, so that the process never runs out of descriptors.

Every open file and socket takes a descriptor, and a process may have so many. People's port is the
only part that takes more and more of them; it leaves a reserve for the private port, so that health
is answered however many people come.
"""

import errno
import os
import resource
from typing import Final

import structlog

log = structlog.get_logger(__name__)

RESERVE: Final = 128
"""Descriptors that people never get: 64 for the private port, and others for files and threads."""

_LEAST: Final = 8
"""A world that fewer connections can reach is not opened."""


def places_for_people(wanted: int) -> int:
    """Return the number of connections that people may have, at most as many as wanted.

    The limit of the process is raised as far as that takes and the system allows. A warning tells
    when it does not suffice.

    Raises
    ------
    OSError
        Next to nobody could come in.
    """
    used = len(os.listdir("/dev/fd"))  # noqa: PTH208 (names suffice)
    needed = used + RESERVE + wanted
    limit = _raised_limit(needed)
    if limit >= needed:
        return wanted
    places = limit - used - RESERVE
    if places < _LEAST:
        raise OSError(
            errno.EMFILE,
            f"this process may have {limit} open files and needs {used + RESERVE + _LEAST} "
            "(ulimit -n)",
        )
    log.warning(
        "fewer connections than max_clients asks for, raise the limit of open files (ulimit -n)",
        connections=places,
        wanted=wanted,
        limit=limit,
        limit_needed=needed,
    )
    return places


def _raised_limit(needed: int) -> int:
    """The limit of open files, raised to what is needed where that is allowed."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft == resource.RLIM_INFINITY:
        return needed
    if soft < needed:
        most = needed if hard == resource.RLIM_INFINITY else min(needed, hard)
        if most > soft:
            try:
                resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))
            except (OSError, ValueError):
                return soft  # the system has a limit below the one it names
            return most
    return soft
