"""`esplanade gait`: pictures and films of walking, the cycle of far figures, plots."""

from argparse import Namespace
from importlib import import_module
from typing import Any

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import UsageError
from esplanade.commandline.output import made_folder
from esplanade.commandline.progress import progress
from esplanade.footage.options import WALKS


def render(options: Namespace) -> int:
    """Draw walks: strips, trails and films."""
    if options.picture != "png":
        _part_that_needs("matplotlib", "esplanade.footage.vector")
    strips = _part_that_needs("PIL", "esplanade.footage.strips")
    films = _part_that_needs("PIL", "esplanade.footage.film")
    walks = _part_that_needs("PIL", "esplanade.footage.walks").walks()
    folder = made_folder("--out", options.out)
    files = []
    with progress() as shown:
        for name in WALKS if options.walk == "all" else (options.walk,):
            task = shown.add_task(name, total=None)
            taken = films.film_walk(walks[name], options.fps, options.seed)
            frames = 0 if options.no_film else len(taken.times_s)
            shown.update(task, total=frames + 2)
            for kind, draw in (("strip", strips.draw_strip), ("trail", strips.draw_trail)):
                files.append(folder / f"{name}-{kind}.{options.picture}")
                draw(taken, files[-1])
                shown.advance(task)
            if not options.no_film:
                files.append(folder / f"{name}.gif")
                strips.draw_film(taken, files[-1], lambda task=task: shown.advance(task))
    print(*files, sep="\n")
    return exit_codes.OK


def cycle(options: Namespace) -> int:
    """Write the cycle of figures that are far away."""
    made = import_module("esplanade.footage.cycle")
    try:
        options.out.write_text(made.as_text(made.cycle()) + "\n", encoding="utf-8")
    except OSError as error:
        raise UsageError(f"--out: {error}") from None
    print(options.out)
    return exit_codes.OK


def plots(options: Namespace) -> int:
    """Draw the plots of docs/walking.md."""
    drawn = _part_that_needs("matplotlib", "esplanade.footage.plots").PLOTS
    folder = made_folder("--out", options.out)
    files = []
    with progress() as shown:
        task = shown.add_task("drawing", total=len(drawn))
        for name, plot in drawn.items():
            files.append(folder / f"walking-{name}.{options.picture}")
            plot(files[-1])
            shown.advance(task)
    print(*files, sep="\n")
    return exit_codes.OK


def _part_that_needs(library: str, module: str) -> Any:
    """A module of ours that draws.

    Raises
    ------
    UsageError
        The library that it draws with is not installed.
    """
    try:
        import_module(library)
    except ImportError:
        raise UsageError(
            f"pictures need {library}: pip install matplotlib, or `pip install '.[gait]'`"
        ) from None
    return import_module(module)
