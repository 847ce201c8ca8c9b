"""Recorded stretches run again with something changed, and what came of it."""
