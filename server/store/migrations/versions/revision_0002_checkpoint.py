"""Checkpoints of the world, seats of people, and numbers that are given away once."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "checkpoints",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("made_us", sa.BigInteger, nullable=False),
        sa.Column("tick", sa.BigInteger, nullable=False),
        sa.Column("scene", sa.String(64), nullable=False),
        sa.Column("scene_name", sa.Text, nullable=False),
        sa.Column("format", sa.String(64), nullable=False),
        sa.Column("digest", sa.String(64), nullable=False),
        sa.Column("payload", sa.LargeBinary, nullable=False),
    )
    op.create_table(
        "seats",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("avatar", sa.BigInteger, primary_key=True, autoincrement=False),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("address", sa.Text, nullable=False),
        sa.Column("digests", sa.Text, nullable=False),
        sa.Column("x", sa.Float(53), nullable=False),
        sa.Column("y", sa.Float(53), nullable=False),
        sa.Column("z", sa.Float(53), nullable=False),
    )
    op.create_index("seats_by_name", "seats", ["zone", "name"])
    op.create_table(
        "reserved",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("name", sa.String(64), primary_key=True),
        sa.Column("until", sa.BigInteger, nullable=False),
    )
