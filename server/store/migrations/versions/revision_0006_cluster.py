"""Owners of zones, and seats of people, of a world on several machines."""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "ownerships",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("epoch", sa.BigInteger, nullable=False),
        sa.Column("host", sa.String(64)),
        sa.Column("until_us", sa.BigInteger, nullable=False),
        sa.Column("wanted_host", sa.String(64)),
    )
    op.create_table(
        "cluster_seats",
        sa.Column("zone", sa.String(64), nullable=False),
        sa.Column(
            "person",
            sa.BigInteger().with_variant(sa.Integer, "sqlite"),
            sa.Identity(always=False),
            primary_key=True,
        ),
        sa.Column("name", sa.Text, nullable=False),
        sa.Column("newest", sa.String(64), nullable=False, unique=True),
        sa.Column("used", sa.String(64), unique=True),
        sa.Column("hops", sa.BigInteger, nullable=False),
        sa.Column("generation", sa.BigInteger, nullable=False),
        sa.Column("gateway", sa.String(64)),
        sa.Column("vacated_us", sa.BigInteger),
        sa.Column("state", sa.LargeBinary, nullable=False),
        sa.UniqueConstraint("zone", "person", name="cluster_seats_by_zone"),
    )
    op.create_index("cluster_seats_by_name", "cluster_seats", ["zone", "name"])
