"""Agents: what each decides in a tick, all in one batch."""
