"""Errors between a bot and its server."""


class BotError(Exception):
    """Base of everything that this package raises about a connection."""


class Unreachable(BotError):  # noqa: N818 (reads as what happened)
    """Nothing that speaks the protocol answers at the address."""


class TimedOut(Unreachable):
    """Somebody is there and does not let us in, nor refuses, for as long as we wait."""


class Refused(BotError):  # noqa: N818 (reads as what happened)
    """The server answered hello with an error; `code` is for programs, `text` for people."""

    def __init__(self, code: str, text: str) -> None:
        super().__init__(f"{code}: {text}")
        self.code = code
        self.text = text


class Disconnected(BotError):  # noqa: N818 (reads as what happened)
    """The connection has ended; `code` is the WebSocket close code (1006: without one)."""

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(f"connection ended with code {code}" + (f": {reason}" if reason else ""))
        self.code = code
        self.reason = reason
