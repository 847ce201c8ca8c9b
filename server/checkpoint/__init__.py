"""Checkpoints: the state of a running world, in the store, so that a restart goes on from there.

It knows the store, and the audit as rows. What a part of a checkpoint means is known to whoever has
registered it (`parts.py`).
"""
