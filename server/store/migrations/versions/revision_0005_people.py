"""Bans, reports, rules of chat, and lines of chat that are kept."""

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "bans",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("id", sa.BigInteger, primary_key=True),
        sa.Column("text", sa.Text, nullable=False),
        sa.Column("until_us", sa.BigInteger),
        sa.Column("at_us", sa.BigInteger, nullable=False),
        sa.Column("account", sa.String(64)),
        sa.Column("digests", sa.Text, nullable=False),
        sa.Column("name_pattern", sa.Text),
        sa.Column("address", sa.Text),
        sa.Column("lifted", sa.Boolean, nullable=False),
    )
    op.create_table(
        "reports",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("id", sa.BigInteger, primary_key=True),
        sa.Column("at_us", sa.BigInteger, nullable=False),
        sa.Column("reporter", sa.BigInteger, nullable=False),
        sa.Column("reporter_name", sa.Text, nullable=False),
        sa.Column("person", sa.BigInteger, nullable=False),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("text", sa.Text, nullable=False),
        sa.Column("place", sa.Text),
        sa.Column("line", sa.BigInteger),
        sa.Column("said", sa.Text),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("settled_by", sa.String(64)),
    )
    op.create_table(
        "chat_rules",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("name", sa.String(128), primary_key=True),
        sa.Column("value", sa.Text, nullable=False),
    )
    op.create_table(
        "chat_lines",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("line", sa.BigInteger, primary_key=True),
        sa.Column("at_us", sa.BigInteger, nullable=False),
        sa.Column("tick", sa.BigInteger, nullable=False),
        sa.Column("avatar", sa.BigInteger, nullable=False),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("text", sa.Text, nullable=False),
        sa.Column("seen", sa.Text, nullable=False),
        sa.Column("hidden", sa.Boolean, nullable=False),
    )
    op.create_index("chat_lines_by_time", "chat_lines", ["zone", "at_us"])
    op.create_index("chat_lines_by_name", "chat_lines", ["zone", "name"])
