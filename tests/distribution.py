"""The distribution of tests over processes that run at the same time."""

from typing import Final

from xdist.scheduler import LoadScopeScheduling  # type: ignore[import-untyped]

TOGETHER: Final = {
    "tests/browser/": "browser",
    "tests/server/clustering/": "cluster",
    "tests/benchmarks/test_cluster.py": "cluster",
}
"""Tests that one process runs, by the beginnings of their names: each of several browsers would
draw on all cores, and a cluster of hosts takes long to begin."""


class Together(LoadScopeScheduling):  # type: ignore[misc]
    """Gives each process that is free the next test, or all tests that are run together."""

    def _split_scope(self, nodeid: str) -> str:
        for beginning, group in TOGETHER.items():
            if nodeid.startswith(beginning):
                return group
        return nodeid
