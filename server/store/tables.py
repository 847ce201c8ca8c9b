"""The tables of the store; the first column of every key is the zone.

Moments are whole microseconds since 1970, UTC, as a bare number: SQLite has no type for them.
"""

from typing import Final

from sqlalchemy import (
    BigInteger,
    Boolean,
    Column,
    Float,
    ForeignKeyConstraint,
    Identity,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
    UniqueConstraint,
)

REVISION: Final = "0008"
"""The newest migration: what the tables below are after it."""

METADATA: Final = MetaData()

ACCOUNTS: Final = Table(
    "accounts",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("name", String(64), primary_key=True),
    Column("role", String(32), nullable=False),
    Column("password_hash", Text),
    Column("created_us", BigInteger, nullable=False),
    Column("seen_us", BigInteger),
)
"""Operators; without a hash, an account comes in by tokens only."""


def _of_account(*, nullable: bool = False) -> tuple[Column[str], ForeignKeyConstraint]:
    """The account that something belongs to, and with which it goes."""
    return (
        Column("account", String(64), nullable=nullable),
        ForeignKeyConstraint(
            ["zone", "account"], ["accounts.zone", "accounts.name"], ondelete="CASCADE"
        ),
    )


SESSIONS: Final = Table(
    "sessions",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("digest", String(64), primary_key=True),
    *_of_account(),
    Column("address", Text, nullable=False),
    Column("created_us", BigInteger, nullable=False),
    Column("used_us", BigInteger, nullable=False),
    Index("sessions_by_account", "zone", "account"),
)
"""Operators who are logged in, by the SHA-256 digest of their token."""

TOKENS: Final = Table(
    "tokens",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("digest", String(64), primary_key=True),
    *_of_account(),
    Column("name", String(64), nullable=False),
    Column("rights", Text, nullable=False),
    Column("created_us", BigInteger, nullable=False),
    Column("expires_us", BigInteger, nullable=False),
    Column("used_us", BigInteger),
    Column("revoked_us", BigInteger),
    UniqueConstraint("zone", "account", "name", name="tokens_by_name"),
)
"""Tokens of scripts, by their SHA-256 digest; rights are words between blanks."""

ONE_TIME: Final = Table(
    "one_time",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("digest", String(64), primary_key=True),
    Column("purpose", String(16), nullable=False),
    *_of_account(nullable=True),
    Column("expires_us", BigInteger, nullable=False),
)
"""Tokens that are used once: the link of the first start, passes to a seat."""

INVITATIONS: Final = Table(
    "invitations",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("id", String(16), primary_key=True),
    Column("digest", String(64), nullable=False),
    Column("label", Text),
    Column("account", String(64)),
    Column("uses", BigInteger, nullable=False),
    Column("used", BigInteger, nullable=False),
    Column("created_us", BigInteger, nullable=False),
    Column("expires_us", BigInteger, nullable=False),
    Column("revoked_us", BigInteger),
    UniqueConstraint("zone", "digest", name="invitations_by_digest"),
)
"""Invitations to a closed world, by the digest of their secret; `account` has made them."""

BOTS: Final = Table(
    "bots",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("name", String(64), primary_key=True),
    Column("digest", String(64), nullable=False),
    Column("account", String(64)),
    Column("message_rate", BigInteger, nullable=False),
    Column("connections", BigInteger, nullable=False),
    Column("created_us", BigInteger, nullable=False),
    Column("expires_us", BigInteger, nullable=False),
    UniqueConstraint("zone", "digest", name="bots_by_digest"),
)
"""Tokens by which bots come in, each with a rate of its own; one that is removed opens nothing."""

AUDIT: Final = Table(
    "audit",
    METADATA,
    # SQLite numbers rows by itself only where the column is INTEGER, which has 64 bits there.
    Column(
        "id", BigInteger().with_variant(Integer, "sqlite"), Identity(always=False), primary_key=True
    ),
    Column("zone", String(64), nullable=False),
    Column("writer", String(64), nullable=False),
    Column("seq", BigInteger, nullable=False),
    Column("at_us", BigInteger, nullable=False),
    Column("tick", BigInteger),
    Column("command", String(64), nullable=False),
    Column("role", String(32), nullable=False),
    Column("target", Text, nullable=False),
    Column("outcome", String(32), nullable=False),
    Column("refers_to", BigInteger),
    Column("body", Text, nullable=False),
    Column("account", String(64)),
    Column("address", Text),
    Column("account_salt", String(32)),
    Column("account_seal", String(64), nullable=False),
    Column("person", Text),
    Column("note", Text),
    Column("detail", Text),
    Column("person_salt", String(32)),
    Column("person_seal", String(64), nullable=False),
    Column("previous", String(64), nullable=False),
    Column("hash", String(64), nullable=False),
    UniqueConstraint("zone", "writer", "seq", name="audit_chain"),
    Index("audit_by_time", "zone", "at_us"),
    Index("audit_by_account", "zone", "account", "at_us"),
    Index("audit_by_command", "zone", "command", "at_us"),
    Index("audit_by_target", "zone", "target", "at_us"),
    Index("audit_by_account_command", "zone", "account", "command", "at_us"),
    Index("audit_by_account_target", "zone", "account", "target", "at_us"),
    Index("audit_by_command_target", "zone", "command", "target", "at_us"),
    Index("audit_by_person", "zone", "person", "at_us"),
)
"""The audit; `esplanade.server.audit.chain` says what is sealed, and what a hash is of."""

AUDIT_HEADS: Final = Table(
    "audit_heads",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("writer", String(64), primary_key=True),
    Column("seq", BigInteger, nullable=False),
    Column("at_us", BigInteger, nullable=False),
    Column("hash", String(64), nullable=False),
)
"""The last row of each writer's chain, so that a cut at its end is seen."""

OPERATED: Final = Table(
    "operated",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("part", String(32), primary_key=True),
    Column("name", String(64), primary_key=True),
    Column("body", Text, nullable=False),
)
"""Presets, schedules and guards of operators, each as JSON."""

CHECKPOINTS: Final = Table(
    "checkpoints",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("made_us", BigInteger, nullable=False),
    Column("tick", BigInteger, nullable=False),
    Column("scene", String(64), nullable=False),
    Column("scene_name", Text, nullable=False),
    Column("format", String(64), nullable=False),
    Column("digest", String(64), nullable=False),
    Column("payload", LargeBinary, nullable=False),
)
"""The newest checkpoint of the world; `scene` and `digest` are SHA-256 of scene and payload."""

SEATS: Final = Table(
    "seats",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("avatar", BigInteger, primary_key=True, autoincrement=False),
    Column("name", Text, nullable=False),
    Column("address", Text, nullable=False),
    Column("digests", Text, nullable=False),
    Column("x", Float(53), nullable=False),
    Column("y", Float(53), nullable=False),
    Column("z", Float(53), nullable=False),
    Index("seats_by_name", "zone", "name"),
)
"""Seats of people, with SHA-256 digests of the tokens that take each, between blanks.

The place is that at which the avatar came into the world.
"""

RESERVED: Final = Table(
    "reserved",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("name", String(64), primary_key=True),
    Column("until", BigInteger, nullable=False),
)
"""Numbers below `until` may have been given away, by what they number."""
BANS: Final = Table(
    "bans",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("id", BigInteger, primary_key=True),
    Column("text", Text, nullable=False),
    Column("until_us", BigInteger),
    Column("at_us", BigInteger, nullable=False),
    Column("account", String(64)),
    Column("digests", Text, nullable=False),
    Column("name_pattern", Text),
    Column("address", Text),
    Column("lifted", Boolean, nullable=False),
)
"""People who are not let in; the digests are a list in JSON."""

REPORTS: Final = Table(
    "reports",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("id", BigInteger, primary_key=True),
    Column("at_us", BigInteger, nullable=False),
    Column("reporter", BigInteger, nullable=False),
    Column("reporter_name", Text, nullable=False),
    Column("person", BigInteger, nullable=False),
    Column("name", Text, nullable=False),
    Column("text", Text, nullable=False),
    Column("place", Text),
    Column("line", BigInteger),
    Column("said", Text),
    Column("state", String(16), nullable=False),
    Column("settled_by", String(64)),
)
"""Reports of people to moderators."""

CHAT_RULES: Final = Table(
    "chat_rules",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("name", String(128), primary_key=True),
    Column("value", Text, nullable=False),
)
"""Rules of chat by their names, JSON."""

CHAT_LINES: Final = Table(
    "chat_lines",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("line", BigInteger, primary_key=True),
    Column("at_us", BigInteger, nullable=False),
    Column("tick", BigInteger, nullable=False),
    Column("avatar", BigInteger, nullable=False),
    Column("name", Text, nullable=False),
    Column("text", Text, nullable=False),
    Column("seen", Text, nullable=False),
    Column("hidden", Boolean, nullable=False),
    Index("chat_lines_by_time", "zone", "at_us"),
    Index("chat_lines_by_name", "zone", "name"),
)
"""Lines of chat, where a server is told to keep them for some days."""

OWNERSHIPS: Final = Table(
    "ownerships",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("epoch", BigInteger, nullable=False),
    Column("host", String(64)),
    Column("until_us", BigInteger, nullable=False),
    Column("wanted_host", String(64)),
)
"""Zones of a world on several machines, and the host that owns each until a moment.

The epoch is the number of the ownership. `wanted_host` is the only host that may claim the zone.
"""

CLUSTER_SEATS: Final = Table(
    "cluster_seats",
    METADATA,
    Column("zone", String(64), nullable=False),
    Column(
        "person",
        BigInteger().with_variant(Integer, "sqlite"),
        Identity(always=False),
        primary_key=True,
    ),
    Column("name", Text, nullable=False),
    Column("newest", String(64), nullable=False, unique=True),
    Column("used", String(64), unique=True),
    Column("hops", BigInteger, nullable=False),
    Column("generation", BigInteger, nullable=False),
    Column("gateway", String(64)),
    Column("vacated_us", BigInteger),
    Column("state", LargeBinary, nullable=False),
    Column("skeleton", Text),
    UniqueConstraint("zone", "person", name="cluster_seats_by_zone"),
    Index("cluster_seats_by_name", "zone", "name"),
    Index("cluster_seats_by_skeleton", "skeleton", unique=True),
)
"""Seats of people in a world on several machines; each is in one zone.

`newest` and `used` are SHA-256 digests of the tokens that take the seat: the newest one, and the
one that was used to get it, until the newest has arrived. No two names have the same skeleton: that
is what `esplanade.server.moderation.skeletons` makes of a name.
"""

CLUSTER_WORLDS: Final = Table(
    "cluster_worlds",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("name", Text, nullable=False),
    Column("subject", String(64), nullable=False),
    Column("start", String(64), nullable=False),
    Column("file", Text, nullable=False),
)
"""The world of a cluster, one row: the word by which the subjects of its messages begin, the zone
that newcomers enter, and the name of the world's file among `cluster_files`."""

CLUSTER_FILES: Final = Table(
    "cluster_files",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("name", String(256), primary_key=True),
    Column("content", LargeBinary, nullable=False),
)
"""The file of the world of a cluster and those of its scenes, by their names."""

CLUSTER_ZONES: Final = Table(
    "cluster_zones",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("epoch", BigInteger, nullable=False),
    Column("described", LargeBinary),
    Column("tick", BigInteger),
    Column("saved_us", BigInteger),
    Column("saved", LargeBinary),
)
"""The facts of each zone that gateways tell newcomers, and its newest checkpoint: the tick of which
it is, and when it was written by the clock of the database. Both are of the owner of that epoch."""

CLUSTER_PROCESSES: Final = Table(
    "cluster_processes",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("name", String(64), primary_key=True),
    Column("kind", String(16), nullable=False),
    Column("address", Text, nullable=False),
    Column("seen_us", BigInteger, nullable=False),
    Column("people", BigInteger, nullable=False),
    Column("drained", Boolean, nullable=False),
)
"""Hosts and gateways that run or have run, when each was last there, and which are to end."""

CLUSTER_TRAVELLERS: Final = Table(
    "cluster_travellers",
    METADATA,
    Column("zone", String(64), primary_key=True),
    Column("actor", String(128), primary_key=True),
    Column("origin", String(64), nullable=False),
    Column("spec", Text, nullable=False),
    Column("parameters", Text, nullable=False),
    Column("has_left", Boolean, nullable=False),
    Column("has_come", Boolean, nullable=False),
    UniqueConstraint("actor", name="cluster_travellers_by_actor"),
)
"""Actors on their way to a zone from another one, with what goes along as JSON; an actor is on one
way at once. `has_left` and `has_come` tell whether the newest checkpoints of the two know of it."""
