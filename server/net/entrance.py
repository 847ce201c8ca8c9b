"""The entrance lets people in: everybody, or into a closed world those who show what lets them in.

Passes of operators and tokens of bots count in an open world too, for the rights and the rate that
they bring.
"""

import hashlib
import hmac
import secrets
from collections import Counter
from dataclasses import dataclass
from time import monotonic
from typing import Final, NoReturn

import structlog

from esplanade.protocol import CloseCode, ErrorCode, ProtocolError
from esplanade.protocol.messages import Admission
from esplanade.server.accounts.bots import Bot
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.lockout import LockedOutError, Lockout
from esplanade.server.accounts.passwords import PasswordsBusyError
from esplanade.server.kept import Kept
from esplanade.server.metrics import Metrics
from esplanade.server.settings import ServerSettings
from esplanade.server.store.store import StoreError

HASHED: Final = "$argon2id$"
"""A password of the world that begins so is a hash already."""

log = structlog.get_logger(__name__)


@dataclass(eq=False)
class Admitted:
    """The admission of a connection. `end` it with the connection."""

    operator: Identity | None = None
    """The operator who walks in."""
    bot: Bot | None = None
    invitation: str | None = None
    """The id of the invitation, one use of which was taken."""


class Entrance:
    """Checks what newcomers show; it is to be called on one event loop."""

    def __init__(self, settings: ServerSettings, kept: Kept, metrics: Metrics) -> None:
        self._closed = settings.closed
        self._by_identity = bool(settings.identity_header)
        self._password = settings.world_password.get_secret_value()
        self._hash = self._password if self._password.startswith(HASHED) else None
        self._kept = kept
        self._lockout = Lockout()
        self._key = secrets.token_bytes(32)
        self._known: bytes | None = None
        self._bots: Counter[str] = Counter()
        self._refused = 0
        metrics.total("admissions_refused", "People who were not let in", lambda: self._refused)
        metrics.gauge("bots_connected", "Bots with a token", self._bots.total)
        metrics.total(
            "world_passwords_wrong", "Wrong passwords of the world", lambda: self._lockout.wrong
        )

    async def check(
        self, admission: Admission | None, address: str, identity: str | None, has_seat: bool
    ) -> Admitted:
        """Let somebody in. `identity` is what a trusted proxy calls them, `has_seat` says that
        they come back to an avatar of theirs.

        Raises
        ------
        ProtocolError
            They are not let in.
        """
        try:
            return await self._check(admission, address, identity, has_seat)
        except ProtocolError:
            self._refused += 1
            raise
        except StoreError as error:
            log.warning("nobody can be let in", fault=str(error))
            _refuse("the server cannot look up what you show; try again later")

    def end(self, admitted: Admitted) -> None:
        """Note that a connection has ended; it may be called more than once."""
        bot, admitted.bot = admitted.bot, None
        if bot is not None:
            self._bots[bot.name] -= 1

    async def turn_away(self, admitted: Admitted) -> None:
        """Take back what was used up for somebody for whom there was no room."""
        self.end(admitted)
        if admitted.invitation is not None:
            await self._kept.invitations.give_back(admitted.invitation)

    async def _check(
        self, admission: Admission | None, address: str, identity: str | None, has_seat: bool
    ) -> Admitted:
        match admission:
            case Admission(way="bot"):
                return await self._bot(admission.secret)
            case Admission(way="pass"):
                operator = await self._kept.one_time.take_pass(admission.secret, address)
                if operator is None and not has_seat:  # who comes back has used it up before
                    _refuse("this pass is not good, or no longer: it is for once, within a minute")
                return Admitted(operator=operator)
            case _ if has_seat:
                return Admitted()
        if not self._closed or identity is not None:
            return Admitted()
        match admission:
            case Admission(way="invitation"):
                invitation = await self._kept.invitations.use(admission.secret)
                if invitation is None:
                    _refuse("this invitation is not good, or no longer; ask for another one")
                return Admitted(invitation=invitation)
            case Admission(way="password") if self._password:
                await self._check_password(admission.secret, address)
                return Admitted()
        code = ErrorCode.PASSWORD_NEEDED if self._password else ErrorCode.ADMISSION_NEEDED
        raise ProtocolError(code, self._what_is_needed(), CloseCode[code.name])

    async def _bot(self, token: str) -> Admitted:
        bot = await self._kept.bots.of(token)
        if bot is None:
            _refuse("this token of a bot opens nothing, or no longer does")
        if self._bots[bot.name] >= bot.connections:
            _refuse(f"the bot {bot.name} has {bot.connections} connections open, all it may have")
        self._bots[bot.name] += 1
        return Admitted(bot=bot)

    async def _check_password(self, password: str, address: str) -> None:
        """Compare the password of the world. Addresses are locked, and never the world itself.

        The right one costs a hash of argon2id only once: a crowd that knows it has not to wait.
        """
        given = hmac.digest(self._key, password.encode("utf-8", "surrogatepass"), hashlib.sha256)
        try:
            self._lockout.take(address, address, monotonic())
            if self._known is None or not hmac.compare_digest(given, self._known):
                if self._hash is None:
                    self._hash = await self._kept.passwords.hash_any(self._password)
                if not await self._kept.passwords.fits(password, self._hash):
                    _refuse("this is not the password of this world")
                self._known = given
        except LockedOutError as error:
            _refuse(str(error))
        except PasswordsBusyError as error:
            self._lockout.forgive(address, address, monotonic())
            _refuse(str(error))
        self._lockout.forgive(address, address, monotonic())

    def _what_is_needed(self) -> str:
        ways = ["an invitation"]
        if self._password:
            ways.append("its password")
        if self._by_identity:
            ways.append("the sign-in in front of it")
        return f"this world is closed; the way in is {' or '.join(ways)}"


def _refuse(text: str) -> NoReturn:
    raise ProtocolError(ErrorCode.ADMISSION_REFUSED, text, CloseCode.ADMISSION_REFUSED)
