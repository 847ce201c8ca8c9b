"""Recordings run again without a server: verified, and written as trajectories."""
