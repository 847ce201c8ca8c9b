"""Makes every attack beside a canary: `python -m chaos`, see `docs/chaos.md`."""

import argparse
import dataclasses
import signal
import sys
import tempfile
from pathlib import Path

from rich.console import Console

from chaos import report, trial
from chaos.attack import Attack
from chaos.attacks.catalogue import ATTACKS
from chaos.judging import Bars, missed
from chaos.processes import ProcessError, raise_file_limit
from chaos.server import ServerError
from esplanade.commandline.progress import progress

MISSED = 1
FAILED = 2
WIDTH = 140
"""Characters of a line in a file or a pipe."""


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m chaos",
        description="Serve a world, attack it, and tell what a well-behaved client saw.",
    )
    parser.add_argument("--seconds", type=float, default=8.0, help="of each attack (default 8)")
    parser.add_argument(
        "--only", action="append", choices=ATTACKS, metavar="NAME", help="this attack; repeatable"
    )
    parser.add_argument("--list", action="store_true", help="list the attacks and end")
    parser.add_argument("--seed", type=int, default=0, help="of world, canary and attackers")
    parser.add_argument("--actors", type=int, default=10, help="in the world (default 10)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write everything seen to a file")
    options = parser.parse_args()
    console = Console()
    if not console.is_terminal:
        console.width = WIDTH
    if options.list:
        for attack in ATTACKS.values():
            console.print(f"{attack.name:16} {attack.about}", highlight=False, soft_wrap=True)
        return 0
    if not sys.platform.startswith("linux"):
        parser.error("attackers come from 127.0.0.2, and memory is read from /proc: needs Linux")
    # When the harness is ended, it ends all that it has started.
    signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))
    try:
        return _run(options, console)
    except (ServerError, ProcessError) as fault:
        console.print(str(fault), markup=False, style="red", soft_wrap=True)
        return FAILED


def _run(options: argparse.Namespace, console: Console) -> int:
    raise_file_limit()  # the server inherits it
    chosen = [ATTACKS[name] for name in dict.fromkeys(options.only or ATTACKS)]
    around_s = trial.SETTLE_S + trial.AFTER_S
    total_s = around_s + options.seconds
    total_s += sum(around_s + max(options.seconds, attack.least_s) for attack in chosen)
    trials = []
    with tempfile.TemporaryDirectory() as folder, progress(share=True, time_left=True) as bar:
        task = bar.add_task("alone", total=total_s)

        def made(attack: Attack | None) -> trial.Trial:
            bar.update(task, description=attack.name if attack else "alone")
            return trial.run(
                attack,
                Path(folder),
                options.seconds,
                options.seed,
                actors=options.actors,
                progress=lambda seconds: bar.advance(task, seconds),
            )

        alone = made(None)
        bars = Bars.beside(alone.sighting)
        for attack in chosen:
            seen = made(attack)
            seen = dataclasses.replace(seen, missed=missed(seen, attack, bars))
            trials.append(seen)
            verdict = f"{len(seen.missed)} bars missed" if seen.missed else "ok"
            bar.console.print(f"{attack.name}: {verdict}", markup=False, highlight=False)
            if options.json:
                report.write_json(options.json, alone, trials, bars)
    report.show(console, alone, trials, bars)
    return MISSED if any(seen.missed for seen in trials) else 0


if __name__ == "__main__":
    sys.exit(main())
