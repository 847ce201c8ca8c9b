"""The store of a server, and all that stands on it, as one object to hand on."""

from dataclasses import dataclass

from esplanade.server.accounts.bots import Bots
from esplanade.server.accounts.directory import Directory
from esplanade.server.accounts.invitations import Invitations
from esplanade.server.accounts.lockout import Lockout
from esplanade.server.accounts.one_time import OneTime
from esplanade.server.accounts.passwords import Passwords
from esplanade.server.accounts.sessions import Sessions
from esplanade.server.accounts.tokens import Tokens
from esplanade.server.audit.log import AuditLog
from esplanade.server.moderation.state import ModerationState
from esplanade.server.store.store import Store


@dataclass(frozen=True)
class Kept:
    """The store of a server, and all that stands on it."""

    store: Store
    audit: AuditLog
    passwords: Passwords
    lockout: Lockout
    directory: Directory
    sessions: Sessions
    tokens: Tokens
    one_time: OneTime
    invitations: Invitations
    bots: Bots
    moderation: ModerationState
    started: int
    """The row of the audit that says that this server, or this zone, has started; 0 where none
    does."""
