"""Hostile clients beside a well-behaved one: what one address can do to everyone else.

Like `benchmarks/` this is no part of the installed package. `docs/chaos.md` says how it is used.
"""
