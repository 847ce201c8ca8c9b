"""The studies as `esplanade evaluate --sensitivity` and `--tune` run them."""

import argparse
from collections.abc import Mapping
from typing import Any

from esplanade.commandline.errors import UsageError
from esplanade.commandline.output import console, made_folder, write_json
from esplanade.evaluation import plotting
from esplanade.evaluation.console import named_sources, places_of, rules_of, walk
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.settings import read_changes, read_choices
from esplanade.evaluation.studies import report, sensitivity, sensitivity_plot, tuning
from esplanade.evaluation.studies.variants import Variant, tables_of, trials_of
from esplanade.evaluation.trials import Source


def show_sensitivity(options: argparse.Namespace) -> None:
    """Vary one setting after the other, then show, write and draw the results."""
    names, base, rules = _begin(options)
    choices = read_choices(options.vary or sensitivity.BEHAVIOUR_PARAMETERS)
    values = sensitivity.ranges(choices, base)
    variants = [
        sensitivity.variant_of(rules, base, name, value)
        for name, taken in values.items()
        for value in taken
    ]
    trials = trials_of(variants, list(names), options.episodes, options.seed)
    tables = tables_of(walk(trials, options), places_of(options, names))
    found = sensitivity.curves(values, base, rules, tables, options.seed)
    report.show_curves(console(), found)
    if options.json is not None:
        told = {"settings": _settings(options, names, base), "points": sensitivity.figures(found)}
        write_json("--json", options.json, told)
    if options.plots is not None:
        sensitivity_plot.draw(options.plots / f"sensitivity.{options.picture or 'svg'}", found)


def show_tuning(options: argparse.Namespace) -> None:
    """Compare candidates, with leave-one-out cross-validation over the places."""
    names, base, rules = _begin(options)
    choices = read_choices(options.vary)
    grid = {name: values for name, values in choices.items() if values is not None}
    listed = [] if options.candidates is None else tuning.read_candidates(options.candidates)
    if not grid and not listed:
        raise UsageError(f"--candidates: {options.candidates} has none")
    places = places_of(options, names)
    if len(set(places.values())) < 2:
        raise UsageError("--tune needs two places, as each is left out of the choice in turn")
    variants = [Variant.of(rules, found) for found in tuning.candidates(grid, listed, base)]
    trials = trials_of(variants, list(names), options.episodes, options.seed)
    tables = tables_of(walk(trials, options), places)
    found = tuning.tune(tables, variants[0], options.seed)
    report.show_tuning(console(), found)
    if options.json is not None:
        told = {"settings": _settings(options, names, base), **tuning.figures(found)}
        write_json("--json", options.json, told)


def _begin(options: argparse.Namespace) -> tuple[dict[Source, str], dict[str, Any], Rules]:
    """The recordings with their names, the settings that all variants share, and the rules."""
    base = read_changes(options.set)
    names = named_sources(options)
    if options.plots is not None:
        made_folder("--plots", options.plots)
        plotting.require_matplotlib()
    return names, base, rules_of(options)


def _settings(
    options: argparse.Namespace, names: Mapping[Source, str], base: Mapping[str, Any]
) -> dict[str, Any]:
    """The conditions of the study, for JSON."""
    return {
        "recordings": list(names.values()),
        "episodes": options.episodes,
        "seed": options.seed,
        "max_acceleration_mps2": options.a_max,
        "interpolation": options.interp,
        "people": options.people,
        "reaction": options.reaction,
        **base,
    }
