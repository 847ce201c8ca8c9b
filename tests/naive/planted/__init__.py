"""The planted step in whole arrays over steps and moments; what the kernels are held to."""

from tests.naive.planted.targets import step_targets

__all__ = ["step_targets"]
