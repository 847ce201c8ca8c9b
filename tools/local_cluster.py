"""Runs a world on several processes of this machine: database, broker, hosts and gateways.

    make cluster                                   the town at http://localhost:8080 and 8081
    make cluster ARGS='--world my.json --gateways 3 --standby 2'

PostgreSQL and nats-server are those of the system (apt-get install postgresql nats-server). All of
it is in a temporary folder and ends with Ctrl-C. In between, any of the processes may be killed.
"""

import argparse
import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Final

import pytest
from tests.server.brokers import nats_server
from tests.server.databases import new_database, postgresql

from esplanade.planning.scene.world_file import WorldError, read_world

TOWN: Final = Path(__file__).parent.parent / "scenes" / "town.json"
FIRST_PORT: Final = 8080
PRIVATE_PORTS: Final = 100
"""The ports for operators are so many above those for people."""


def main(words: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="make cluster",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--world", type=Path, default=TOWN, help="the world's file [the town]")
    parser.add_argument("--gateways", type=int, default=2, help="number of gateways [2]")
    parser.add_argument("--standby", type=int, default=1, help="hosts that stand by [1]")
    parser.add_argument("--port", type=int, default=FIRST_PORT, help="port of the first [8080]")
    options = parser.parse_args(words)
    try:
        zones = [zone.name for zone in read_world(options.world).file.zones]
    except (OSError, WorldError) as error:
        sys.stderr.write(f"make cluster: {error}\n")
        return 2
    # The end of this process is that of all that it has begun.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return run(options, zones)
    except pytest.skip.Exception as missing:
        sys.stderr.write(f"make cluster: {missing}\n")
        return 1
    except KeyboardInterrupt:
        return 130


def run(options: argparse.Namespace, zones: Sequence[str]) -> int:
    """Run until Ctrl-C, or until a process ends in order."""
    with ExitStack() as stack:
        broker = stack.enter_context(nats_server())
        database = new_database(stack.enter_context(postgresql()))
        environment = {
            **os.environ,
            "ESPLANADE_STORE": database,
            "ESPLANADE_NATS": broker.address,
        }
        esplanade = [sys.executable, "-m", "esplanade"]
        subprocess.run(
            [*esplanade, "cluster", "init", str(options.world)], check=True, env=environment
        )
        processes: list[subprocess.Popen[bytes]] = []
        stack.callback(end, processes)

        def begin(*rest: str) -> None:
            # Ctrl-C is for this process, which ends the others in their order.
            process = subprocess.Popen([*esplanade, *rest], env=environment, start_new_session=True)
            processes.append(process)

        for number in range(options.gateways):
            port, private = options.port + number, options.port + PRIVATE_PORTS + number
            ports = "--port", str(port), "--private-port", str(private)
            begin("gateway", "--name", f"gateway-{number + 1}", *ports)
        for number in range(len(zones) + options.standby):
            begin("zone", "--name", f"host-{number + 1}")
        print(f"\n  to look at it: ESPLANADE_STORE='{database}' esplanade cluster status")
        print(f"  for operators: http://localhost:{options.port + PRIVATE_PORTS}/console/\n")
        while any(process.poll() is None for process in processes):
            time.sleep(0.5)
    return 0


def end(processes: Sequence["subprocess.Popen[bytes]"]) -> None:
    """Let processes end in order, and wait for that."""
    for process in processes:
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
    for process in processes:
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


if __name__ == "__main__":
    sys.exit(main())
