"""Chaos in a cluster: processes are killed and frozen, servers go away, bots keep a ledger."""
