"""The studies as `esplanade evaluate --sensitivity` and `--tune` run them."""

import argparse
from collections.abc import Mapping, Sequence
from typing import Any

from esplanade.commandline.errors import UsageError
from esplanade.commandline.output import console, made_folder, write_json
from esplanade.evaluation import plotting
from esplanade.evaluation.console import named_sources, places_of, rules_of, walk
from esplanade.evaluation.report import show_faults
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.settings import read_changes
from esplanade.evaluation.studies import report, sensitivity, sensitivity_plot, tuning
from esplanade.evaluation.studies.subjects import OUR_ACTOR, Subject, subject_of
from esplanade.evaluation.studies.variants import Tables, Variant, tables_of, trials_of
from esplanade.evaluation.trials import Source
from esplanade.policies.names import own_options


def show_sensitivity(options: argparse.Namespace) -> None:
    """Vary one setting after the other, then show, write and draw the results."""
    names, subject, base, rules = _begin(options)
    choices = subject.read_choices(options.vary or sensitivity.BEHAVIOUR_PARAMETERS)
    values = sensitivity.ranges(choices, base, subject)
    variants = [
        sensitivity.variant_of(rules, base, name, value, subject)
        for name, taken in values.items()
        for value in taken
    ]
    tables = _walked(variants, options, names, places_of(options, names))
    found = sensitivity.curves(values, base, rules, tables, options.seed, subject)
    report.show_curves(console(), found)
    if options.json is not None:
        told = {"settings": _settings(options, names, base), "points": sensitivity.figures(found)}
        write_json("--json", options.json, told)
    if options.plots is not None:
        sensitivity_plot.draw(options.plots / f"sensitivity.{options.picture or 'svg'}", found)


def show_tuning(options: argparse.Namespace) -> None:
    """Compare candidates, with leave-one-out cross-validation over the places."""
    names, subject, base, rules = _begin(options)
    choices = subject.read_choices(options.vary)
    grid = {name: values for name, values in choices.items() if values is not None}
    listed = (
        [] if options.candidates is None else tuning.read_candidates(options.candidates, subject)
    )
    if not grid and not listed:
        raise UsageError(f"--candidates: {options.candidates} has none")
    places = places_of(options, names)
    if len(set(places.values())) < 2:
        raise UsageError("--tune needs two places, as each is left out of the choice in turn")
    candidates = tuning.candidates(grid, listed, base, subject)
    variants = [subject.variant(rules, found) for found in candidates]
    tables = _walked(variants, options, names, places)
    found = tuning.tune(tables, variants[0], options.seed)
    report.show_tuning(console(), found)
    if options.json is not None:
        told = {"settings": _settings(options, names, base), **tuning.figures(found)}
        write_json("--json", options.json, told)


def _begin(
    options: argparse.Namespace,
) -> tuple[dict[Source, str], Subject, dict[str, Any], Rules]:
    """The recordings with their names, the policy, what all variants share, and the rules."""
    policy = options.policy[0]
    subject = subject_of(policy)
    given = own_options(policy, options.policy_option)
    base = read_changes(options.set) if subject is OUR_ACTOR else given
    names = named_sources(options)
    if options.plots is not None:
        made_folder("--plots", options.plots)
        plotting.require_matplotlib()
    return names, subject, base, rules_of(options)


def _walked(
    variants: Sequence[Variant],
    options: argparse.Namespace,
    names: Mapping[Source, str],
    places: Mapping[Source, str],
) -> dict[Variant, Tables]:
    """The measures of every variant, after its faults have been told."""
    trials = trials_of(variants, list(names), options.episodes, options.seed)
    results = walk(trials, options)
    show_faults(console(), results, names)
    return tables_of(results, places)


def _settings(
    options: argparse.Namespace, names: Mapping[Source, str], base: Mapping[str, Any]
) -> dict[str, Any]:
    """The conditions of the study, for JSON."""
    return {
        "policy": options.policy[0],
        "recordings": list(names.values()),
        "episodes": options.episodes,
        "seed": options.seed,
        "max_acceleration_mps2": options.a_max,
        "interpolation": options.interp,
        "people": options.people,
        "reaction": options.reaction,
        **base,
    }
