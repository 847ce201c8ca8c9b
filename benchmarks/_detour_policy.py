"""The crowd of Detour as a policy, in a process of Node.js that listens on a free port."""

import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

from benchmarks._node import node_program
from benchmarks._node_process import RECAST


@contextmanager
def detour() -> Iterator[str]:
    """The name of the policy, as long as the process runs."""
    command = [node_program(), "policy.mjs", "0"]
    with subprocess.Popen(command, cwd=RECAST, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            port = int(process.stdout.readline().split()[-1])
            yield f"tcp://127.0.0.1:{port}/detour"
        finally:
            process.kill()
