"""The one table of all numbers of the wire: versions, codes, limits.

`docs/protocol.md` explains each entry; `client_web/src/net/codes.ts` repeats the numbers for
the browser and `tests/protocol/test_codes.py` holds the two together.
"""

from enum import IntEnum, StrEnum

VERSION = 6
"""The newest version of the protocol, which our own clients speak."""

SERVED_VERSIONS = (4, 5, 6)
"""Every version that the server speaks, the oldest first. From 4 on it also serves the version
before its own: a client tells its version in hello, and welcome repeats it."""

MAX_CLIENT_FRAME_BYTES = 2048
"""A larger frame from a client ends the connection (close code 1009)."""

MAX_NAME_CHARS = 32
MAX_CHAT_CHARS = 300
MAX_TOKEN_CHARS = 64
MAX_DOOR_CHARS = 64
MAX_SECRET_CHARS = 256
MAX_LINE_NUMBER = 2**53 - 1
"""Numbers of lines are whole in a float of 64 bits, which is all that browsers have."""


class ClientCode(IntEnum):
    """First element of every message that a client sends."""

    HELLO = 1
    MOVE = 2
    WALK_TO = 3
    CHAT = 4
    PING = 5
    WATCH = 6
    SET_DOOR = 7
    REPORT = 8
    MUTE = 9
    PRESENCE = 10
    GESTURE = 11
    LOOK = 12


class ServerCode(IntEnum):
    """First element of every message that the server sends."""

    WELCOME = 64
    ENTER = 65
    LEAVE = 66
    SNAPSHOT = 67
    CHAT = 68
    NOTICE = 69
    ERROR = 70
    BYE = 71
    PONG = 72
    PLAN = 73
    CENSUS = 74
    DOORS = 75
    STEPS = 76
    POINT = 77
    RESHAPE = 78
    HIDE = 79
    TRAVEL = 80
    AWAY = 81
    GESTURE = 82


class Kind(StrEnum):
    """The kinds of avatars, by the one who moves them."""

    PERSON = "person"
    ACTOR = "actor"


class Reason(IntEnum):
    """Why an actor does what it does; people carry NONE."""

    NONE = 0
    MOVING = 1
    GIVING_WAY = 2
    WAITING = 3
    REPLANNING = 4
    NO_PATH = 5
    ARRIVED = 6


class Gesture(IntEnum):
    """The gestures of avatars."""

    WAVE = 1
    NOD = 2
    POINT = 3
    CLAP = 4
    DANCE = 5
    RAISE_HAND = 6


class Outcome(IntEnum):
    """How the trip of an actor ended."""

    ARRIVED = 1
    NEAR = 2
    BLOCKED = 3
    NO_WAY = 4


class ErrorCode(StrEnum):
    """Machine-readable name inside an `error` message."""

    UNSUPPORTED_VERSION = "unsupported_version"
    MALFORMED = "malformed"
    INVALID = "invalid"
    HELLO_EXPECTED = "hello_expected"
    HELLO_TIMEOUT = "hello_timeout"
    TOO_LARGE = "too_large"
    FLOODING = "flooding"
    SERVER_FULL = "server_full"
    NO_PATH = "no_path"
    GOAL_MOVED = "goal_moved"
    FORBIDDEN = "forbidden"
    NAME_RESERVED = "name_reserved"
    KEY_UNREAD = "key_unread"
    LEASE_ENDED = "lease_ended"
    MUTED = "muted"
    ADMISSION_NEEDED = "admission_needed"
    PASSWORD_NEEDED = "password_needed"  # noqa: S105
    ADMISSION_REFUSED = "admission_refused"
    BANNED = "banned"
    SLOW_MODE = "slow_mode"
    WORD_REFUSED = "word_refused"
    QUIET_ZONE = "quiet_zone"
    BUSY = "busy"


class CloseCode(IntEnum):
    """WebSocket close codes; 4000 and above are ours."""

    NORMAL = 1000
    GOING_AWAY = 1001
    TOO_LARGE = 1009
    BUSY = 1013
    UNSUPPORTED_VERSION = 4001
    MALFORMED = 4002
    INVALID = 4003
    FLOODING = 4004
    HELLO_EXPECTED = 4005
    HELLO_TIMEOUT = 4006
    SERVER_FULL = 4007
    TOO_SLOW = 4008
    REPLACED = 4009
    SILENT = 4010
    NAME_RESERVED = 4011
    KICKED = 4012
    ADMISSION_NEEDED = 4020
    PASSWORD_NEEDED = 4021
    ADMISSION_REFUSED = 4022
    BANNED = 4013


class ByeCode(StrEnum):
    """Why the server ends a connection in good order."""

    SHUTDOWN = "shutdown"
    REPLACED = "replaced"
    SILENT = "silent"
    KICKED = "kicked"
    BANNED = "banned"
    WALKED_OUT = "walked_out"


class NoticeCode(StrEnum):
    """The matter of a notice; empty for a sentence that stands for itself."""

    NONE = ""
    ANNOUNCEMENT = "announcement"
    MUTED = "muted"
    UNMUTED = "unmuted"
    WARNED = "warned"
    WALKED_OUT = "walked_out"
    REPORT_TAKEN = "report_taken"
    PAUSED = "paused"
    RESUMED = "resumed"
    PACE = "pace"
    GOAL_MOVED = "goal_moved"
    NOT_LET_IN = "not_let_in"
