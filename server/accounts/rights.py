"""Rights of operators: each role is a set of rights, and each command needs one right."""

from collections.abc import Mapping
from enum import StrEnum
from typing import Final


class Right(StrEnum):
    """Something that an operator may do; a token of a script may hold some of its account's."""

    WATCH = "watch"
    """See the world, its parameters, its changes and its figures."""
    ANNOUNCE = "announce"
    """Say something to people."""
    MODERATE = "moderate"
    """Mute, kick and ban people."""
    PARAMETERS = "parameters"
    """Change parameters, and take changes back."""
    BEHAVIOURS = "behaviours"
    """Say where actors go, and put them into groups."""
    PRESETS = "presets"
    """Save presets."""
    SCHEDULES = "schedules"
    """Have commands carried out later, and moments marked."""
    EXPERIMENTS = "experiments"
    """Start and stop experiments."""
    ACTORS = "actors"
    """Add and remove actors."""
    DOORS = "doors"
    """Open and close doors."""
    PACE = "pace"
    """Pause the world, and let it run slower or faster."""
    RECORDINGS = "recordings"
    """Record, and go back to what was recorded."""
    AUDIT = "audit"
    """Read the audit, with addresses and names, and take it away as a file."""
    ACCOUNTS = "accounts"
    """Add, change and remove accounts and everybody's tokens."""


Rights = frozenset[Right]

_VIEWER: Final[Rights] = frozenset({Right.WATCH})
_MODERATOR: Final = _VIEWER | {Right.ANNOUNCE, Right.MODERATE}
_TUNER: Final = _MODERATOR | {
    Right.PARAMETERS,
    Right.BEHAVIOURS,
    Right.PRESETS,
    Right.SCHEDULES,
    Right.EXPERIMENTS,
}
_DIRECTOR: Final = _TUNER | {Right.ACTORS, Right.DOORS, Right.PACE, Right.RECORDINGS}
_ADMIN: Final = _DIRECTOR | {Right.AUDIT, Right.ACCOUNTS}

ROLES: Final[Mapping[str, Rights]] = {
    "viewer": _VIEWER,
    "moderator": _MODERATOR,
    "tuner": _TUNER,
    "director": _DIRECTOR,
    "admin": _ADMIN,
    "auditor": _VIEWER | {Right.AUDIT},
}
"""The rights of each role; from viewer to admin each has those of the one before."""

COMMANDS: Final[Mapping[str, Right]] = {
    "set_parameters": Right.PARAMETERS,
    "clear_parameters": Right.PARAMETERS,
    "apply_preset": Right.PARAMETERS,
    "revert": Right.PARAMETERS,
    "save_preset": Right.PRESETS,
    "delete_preset": Right.PRESETS,
    "set_group": Right.BEHAVIOURS,
    "set_behaviour": Right.BEHAVIOURS,
    "send_actor": Right.BEHAVIOURS,
    "hold_actor": Right.BEHAVIOURS,
    "add_actors": Right.ACTORS,
    "remove_actors": Right.ACTORS,
    "move_door": Right.DOORS,
    "pace": Right.PACE,
    "announce": Right.ANNOUNCE,
    "mute": Right.MODERATE,
    "kick": Right.MODERATE,
    "ban": Right.MODERATE,
    "unban": Right.MODERATE,
    "warn": Right.MODERATE,
    "walk_out": Right.MODERATE,
    "hide_line": Right.MODERATE,
    "slow_mode": Right.MODERATE,
    "word_filter": Right.MODERATE,
    "quiet_zone": Right.MODERATE,
    "settle_report": Right.MODERATE,
    "mark": Right.SCHEDULES,
    "schedule": Right.SCHEDULES,
    "cancel_schedule": Right.SCHEDULES,
    "record": Right.RECORDINGS,
    "experiment_start": Right.EXPERIMENTS,
    "experiment_stop": Right.EXPERIMENTS,
    "user_add": Right.ACCOUNTS,
    "user_remove": Right.ACCOUNTS,
    "user_role": Right.ACCOUNTS,
    "user_password": Right.ACCOUNTS,
    "token_add": Right.ACCOUNTS,
    "token_revoke": Right.ACCOUNTS,
}
"""The right that each command needs. A command that contains others, as a schedule does, or that
takes one back, needs the rights of those too."""


def may(rights: Rights, command: str) -> bool:
    """Whether these rights suffice for a command; nothing suffices for one that is not known."""
    needed = COMMANDS.get(command)
    return needed is not None and needed in rights


def as_text(rights: Rights) -> str:
    """Rights as words between blanks, in the order in which they are declared."""
    return " ".join(right.value for right in Right if right in rights)


def of_text(text: str) -> Rights:
    """The rights that are named; a name that is no longer known gives none."""
    known = {right.value: right for right in Right}
    return frozenset(known[word] for word in text.split() if word in known)
