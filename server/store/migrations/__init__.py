"""The migrations of the store: one file for each revision, run in order by alembic.

Revisions are numbers of four digits that count up. `python -m alembic` is not needed: a new file is
written by hand beside the last one, and a test compares what all of them make with `tables.py`.
"""
