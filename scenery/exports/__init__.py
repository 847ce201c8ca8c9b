"""Scenes written for other programs."""
