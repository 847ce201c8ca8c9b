"""Readers of mesh files, one file for each format, and what they have in common."""
