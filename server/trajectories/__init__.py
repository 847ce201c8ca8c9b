"""Trajectories of a world that runs, as files: samples, notes, and the thread that writes them."""
