"""Esplanade: a shared place where people and computer-run actors walk among each other."""

from importlib.metadata import version

__version__ = version("esplanade")
