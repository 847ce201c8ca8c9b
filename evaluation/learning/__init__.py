"""Environments in which policies are learned: Gymnasium's for one robot, PettingZoo's for several.

Only `trips` and `crowds` need these packages (extra `learn`); features need numpy alone.
"""
