"""`esplanade gait`: pictures and films of walking, the cycle of far figures, plots."""

import argparse
import sys
from collections.abc import Callable, Sequence
from typing import Final

from esplanade.footage.console import UsageError, made_folder, part_that_needs, progress
from esplanade.footage.options import WALKS, parser

EXIT_WELL: Final = 0
EXIT_USAGE: Final = 2


def run(argv: Sequence[str]) -> int:
    """Do what the command line says, and return the exit code."""
    options = parser().parse_args(argv)
    try:
        return _COMMANDS[options.command](options)
    except UsageError as error:
        print(f"esplanade gait {options.command}: {error}", file=sys.stderr)
        return EXIT_USAGE


def _render(options: argparse.Namespace) -> int:
    strips = part_that_needs("PIL", "esplanade.footage.strips")
    films = part_that_needs("PIL", "esplanade.footage.film")
    walks = part_that_needs("PIL", "esplanade.footage.walks").walks()
    folder = made_folder(options.out)
    files = []
    with progress() as shown:
        for name in WALKS if options.walk == "all" else (options.walk,):
            task = shown.add_task(name, total=None)
            taken = films.film_walk(walks[name], options.fps, options.seed)
            frames = 0 if options.no_film else len(taken.times_s)
            shown.update(task, total=frames + 2)
            for kind, draw in (("strip", strips.draw_strip), ("trail", strips.draw_trail)):
                files.append(folder / f"{name}-{kind}.png")
                draw(taken, files[-1])
                shown.advance(task)
            if not options.no_film:
                files.append(folder / f"{name}.gif")
                strips.draw_film(taken, files[-1], lambda task=task: shown.advance(task))
    print(*files, sep="\n")
    return EXIT_WELL


def _cycle(options: argparse.Namespace) -> int:
    cycle = part_that_needs("numpy", "esplanade.footage.cycle")
    try:
        options.out.write_text(cycle.as_text(cycle.cycle()) + "\n", encoding="utf-8")
    except OSError as error:
        raise UsageError(f"--out: {error}") from None
    print(options.out)
    return EXIT_WELL


def _plots(options: argparse.Namespace) -> int:
    plots = part_that_needs("matplotlib", "esplanade.footage.plots").PLOTS
    folder = made_folder(options.out)
    files = []
    with progress() as shown:
        task = shown.add_task("drawing", total=len(plots))
        for name, plot in plots.items():
            files.append(folder / f"walking-{name}.svg")
            plot(files[-1])
            shown.advance(task)
    print(*files, sep="\n")
    return EXIT_WELL


_COMMANDS: Final[dict[str, Callable[[argparse.Namespace], int]]] = {
    "render": _render,
    "cycle": _cycle,
    "plots": _plots,
}
