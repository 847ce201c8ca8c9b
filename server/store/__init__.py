"""The store: what outlives the process, in SQLite or PostgreSQL.

It knows tables, transactions and migrations. It knows no network, no world, and not what its rows
are used for: `esplanade.server.audit` and `esplanade.server.accounts` stand on it.
"""
