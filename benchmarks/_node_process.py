"""A program of Node.js that answers each line of JSON by one."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any, Final

from benchmarks._node import node_missing, node_program

RECAST: Final = Path(__file__).parent / "recast"


class NodeProcess:
    """A process that runs a program in `benchmarks/recast` until it is closed."""

    def __init__(self, program: str) -> None:
        self._node = subprocess.Popen(
            [node_program(), program],
            cwd=RECAST,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def ask(self, request: dict[str, Any]) -> dict[str, Any]:
        """The answer to a request.

        Raises
        ------
        RuntimeError
            The process has ended, or reports an error.
        """
        assert self._node.stdin is not None
        assert self._node.stdout is not None
        self._node.stdin.write(json.dumps(request) + "\n")
        self._node.stdin.flush()
        line = self._node.stdout.readline()
        if not line:
            raise RuntimeError(f"the Node.js process has ended with code {self._node.wait()}")
        reply: dict[str, Any] = json.loads(line)
        if "error" in reply:
            raise RuntimeError(f"the Node.js process reports: {reply['error']}")
        return reply

    def close(self) -> None:
        """Let the process end."""
        self._node.communicate()


def recast_missing() -> str | None:
    """A message about what must be installed first; None if everything is installed."""
    if absent := node_missing():
        return absent
    if not (RECAST / "node_modules" / "@recast-navigation").is_dir():
        return "Recast is absent: python tools/npm.py --prefix ../benchmarks/recast ci"
    return None
