"""Accounts, sessions, tokens, and the audit."""

from typing import Final

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None

KEPT: Final = (
    "id, zone, writer, seq, at_us, tick, command, role, target, outcome, refers_to, body, "
    "account_seal, person_seal, previous, hash"
)
"""Columns that never change in a row of the audit."""
FORGOTTEN: Final = (
    "account", "address", "account_salt", "person", "note", "detail", "person_salt",
)  # fmt: skip
"""Columns that may become null, and take no other value."""


def upgrade() -> None:
    """Make the tables, and let rows of the audit be added only."""
    _accounts()
    _audit()
    if op.get_context().dialect.name == "sqlite":
        _append_only_in_sqlite()
    else:
        _append_only_in_postgresql()


def _accounts() -> None:
    op.create_table(
        "accounts",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("name", sa.String(64), primary_key=True),
        sa.Column("role", sa.String(32), nullable=False),
        sa.Column("password_hash", sa.Text),
        sa.Column("created_us", sa.BigInteger, nullable=False),
        sa.Column("seen_us", sa.BigInteger),
    )
    op.create_table(
        "sessions",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("digest", sa.String(64), primary_key=True),
        sa.Column("account", sa.String(64), nullable=False),
        _to_account(),
        sa.Column("address", sa.Text, nullable=False),
        sa.Column("created_us", sa.BigInteger, nullable=False),
        sa.Column("used_us", sa.BigInteger, nullable=False),
    )
    op.create_index("sessions_by_account", "sessions", ["zone", "account"])
    op.create_table(
        "tokens",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("digest", sa.String(64), primary_key=True),
        sa.Column("account", sa.String(64), nullable=False),
        _to_account(),
        sa.Column("name", sa.String(64), nullable=False),
        sa.Column("rights", sa.Text, nullable=False),
        sa.Column("created_us", sa.BigInteger, nullable=False),
        sa.Column("expires_us", sa.BigInteger, nullable=False),
        sa.Column("used_us", sa.BigInteger),
        sa.Column("revoked_us", sa.BigInteger),
        sa.UniqueConstraint("zone", "account", "name", name="tokens_by_name"),
    )
    op.create_table(
        "one_time",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("digest", sa.String(64), primary_key=True),
        sa.Column("purpose", sa.String(16), nullable=False),
        sa.Column("account", sa.String(64)),
        _to_account(),
        sa.Column("expires_us", sa.BigInteger, nullable=False),
    )


def _to_account() -> sa.ForeignKeyConstraint:
    return sa.ForeignKeyConstraint(
        ["zone", "account"], ["accounts.zone", "accounts.name"], ondelete="CASCADE"
    )


def _audit() -> None:
    op.create_table(
        "audit",
        sa.Column(
            "id",
            sa.BigInteger().with_variant(sa.Integer, "sqlite"),
            sa.Identity(always=False),
            primary_key=True,
        ),
        sa.Column("zone", sa.String(64), nullable=False),
        sa.Column("writer", sa.String(64), nullable=False),
        sa.Column("seq", sa.BigInteger, nullable=False),
        sa.Column("at_us", sa.BigInteger, nullable=False),
        sa.Column("tick", sa.BigInteger),
        sa.Column("command", sa.String(64), nullable=False),
        sa.Column("role", sa.String(32), nullable=False),
        sa.Column("target", sa.Text, nullable=False),
        sa.Column("outcome", sa.String(32), nullable=False),
        sa.Column("refers_to", sa.BigInteger),
        sa.Column("body", sa.Text, nullable=False),
        sa.Column("account", sa.String(64)),
        sa.Column("address", sa.Text),
        sa.Column("account_salt", sa.String(32)),
        sa.Column("account_seal", sa.String(64), nullable=False),
        sa.Column("person", sa.Text),
        sa.Column("note", sa.Text),
        sa.Column("detail", sa.Text),
        sa.Column("person_salt", sa.String(32)),
        sa.Column("person_seal", sa.String(64), nullable=False),
        sa.Column("previous", sa.String(64), nullable=False),
        sa.Column("hash", sa.String(64), nullable=False),
        sa.UniqueConstraint("zone", "writer", "seq", name="audit_chain"),
    )
    for name, columns in (
        ("time", ()),
        ("account", ("account",)),
        ("command", ("command",)),
        ("target", ("target",)),
        ("person", ("person",)),
        ("account_command", ("account", "command")),
        ("account_target", ("account", "target")),
        ("command_target", ("command", "target")),
    ):
        op.create_index(f"audit_by_{name}", "audit", ["zone", *columns, "at_us"])
    op.create_table(
        "audit_heads",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("writer", sa.String(64), primary_key=True),
        sa.Column("seq", sa.BigInteger, nullable=False),
        sa.Column("at_us", sa.BigInteger, nullable=False),
        sa.Column("hash", sa.String(64), nullable=False),
    )


def _append_only_in_sqlite() -> None:
    refusal = "BEGIN SELECT RAISE(ABORT, 'rows of the audit are added only'); END"
    for name, when in (
        ("audit_kept", f"UPDATE OF {KEPT} ON audit"),
        ("audit_forgets_only", f"UPDATE OF {', '.join(FORGOTTEN)} ON audit WHEN {_differs()}"),
        ("audit_not_deleted", "DELETE ON audit"),
    ):
        op.execute(f"CREATE TRIGGER {name} BEFORE {when} {refusal}")


def _append_only_in_postgresql() -> None:
    op.execute(
        "CREATE FUNCTION audit_refuses() RETURNS trigger LANGUAGE plpgsql AS $$ "
        "BEGIN RAISE EXCEPTION 'rows of the audit are added only'; END $$"
    )
    for name, when in (
        ("audit_kept", f"UPDATE OF {KEPT} ON audit FOR EACH ROW"),
        (
            "audit_forgets_only",
            f"UPDATE OF {', '.join(FORGOTTEN)} ON audit FOR EACH ROW WHEN ({_differs()})",
        ),
        ("audit_not_deleted", "DELETE ON audit FOR EACH ROW"),
        ("audit_not_emptied", "TRUNCATE ON audit FOR EACH STATEMENT"),
    ):
        op.execute(f"CREATE TRIGGER {name} BEFORE {when} EXECUTE FUNCTION audit_refuses()")


def _differs() -> str:
    """A value has changed to something that is not null."""
    return " OR ".join(
        f"(NEW.{column} IS NOT NULL AND (OLD.{column} IS NULL OR NEW.{column} <> OLD.{column}))"
        for column in FORGOTTEN
    )
