"""Recorded people who react to actors among them, by a social force model."""

from esplanade.pedestrians.crowd import ReactingCrowd, Walk
from esplanade.pedestrians.model import SocialForce

__all__ = ["ReactingCrowd", "SocialForce", "Walk"]
