"""Files, zones and processes of a world on several machines, and names that are unlike."""

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"


def upgrade() -> None:
    """Make the tables, and the column by which no two people have names that look alike."""
    op.create_table(
        "cluster_worlds",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("subject", sa.String(64), nullable=False),
        sa.Column("start", sa.String(64), nullable=False),
        sa.Column("file", sa.Text, nullable=False),
    )
    op.create_table(
        "cluster_files",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("name", sa.String(256), primary_key=True),
        sa.Column("content", sa.LargeBinary, nullable=False),
    )
    op.create_table(
        "cluster_zones",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("epoch", sa.BigInteger, nullable=False),
        sa.Column("described", sa.LargeBinary),
        sa.Column("tick", sa.BigInteger),
        sa.Column("saved_us", sa.BigInteger),
        sa.Column("saved", sa.LargeBinary),
    )
    op.create_table(
        "cluster_processes",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("name", sa.String(64), primary_key=True),
        sa.Column("kind", sa.String(16), nullable=False),
        sa.Column("address", sa.Text, nullable=False),
        sa.Column("seen_us", sa.BigInteger, nullable=False),
        sa.Column("people", sa.BigInteger, nullable=False),
        sa.Column("drained", sa.Boolean, nullable=False),
    )
    op.add_column("cluster_seats", sa.Column("skeleton", sa.Text))
    op.create_index("cluster_seats_by_skeleton", "cluster_seats", ["skeleton"], unique=True)
