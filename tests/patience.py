"""The longest times that tests wait for something to happen.

A wait that ends too late fails a test only when nothing happens any more: no test measures how
fast the machine is. Both times are many times what a slow and busy machine needs.
"""

from typing import Final

PATIENCE_S: Final = 180.0
"""The longest wait for a program that runs: an answer, a picture, the end of a process."""

COMPILING_PATIENCE_S: Final = 1500.0
"""The longest wait for a process that may have to compile every kernel before it begins.

`timeout` in pyproject.toml, which ends a test that hangs without any wait, is longer than this.
"""
