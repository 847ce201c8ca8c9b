"""Actors on their way between zones of a world on several machines."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"


def upgrade() -> None:
    """Make the table."""
    op.create_table(
        "cluster_travellers",
        sa.Column("zone", sa.String(64), primary_key=True),
        sa.Column("actor", sa.String(128), primary_key=True),
        sa.Column("origin", sa.String(64), nullable=False),
        sa.Column("spec", sa.Text, nullable=False),
        sa.Column("parameters", sa.Text, nullable=False),
        sa.Column("has_left", sa.Boolean, nullable=False),
        sa.Column("has_come", sa.Boolean, nullable=False),
        sa.UniqueConstraint("actor", name="cluster_travellers_by_actor"),
    )
