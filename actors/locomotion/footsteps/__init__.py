"""Footsteps: when a body steps, where its feet land, and everyone's steps from tick to tick."""
