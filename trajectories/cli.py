"""`esplanade recording`: says how a recorded crowd is read, draws it, writes it."""

import hashlib
import json
import math
import sys
from argparse import Namespace
from pathlib import Path
from typing import Any

from rich.table import Table

from esplanade import __version__
from esplanade.commandline import exit_codes
from esplanade.commandline.errors import UsageError
from esplanade.commandline.output import console
from esplanade.commandline.recording_settings import tell_recording
from esplanade.recordings import Crowd, RecordingError, Report, read_crowd
from esplanade.recordings.writing import WritingError, write_crowd
from esplanade.trajectories.drawing import DrawingError, draw_crowd


def check(options: Namespace) -> int:
    """Print how a recording is read, draw it where that is wanted; returns the exit code."""
    try:
        crowd = read_crowd(
            options.recording,
            options.fps,
            unit=options.unit,
            scale=options.scale,
            strict=options.strict,
            columns=options.columns or (),
        )
    except RecordingError as error:
        raise UsageError(str(error)) from None
    report = crowd.report
    if report is None:
        raise UsageError(f"{options.recording}: nothing is known of it")
    if options.json:
        print(json.dumps(figures(crowd, report), indent=1, allow_nan=False))
    else:
        print(f"{options.recording}: {report.line}")
        console().print(_table(crowd, report))
        for remark in report.remarks:
            print(f"{options.recording}: {remark}")
    for warning in report.warnings:
        print(f"{options.recording}: warning: {warning}", file=sys.stderr)
    if options.out is not None:
        try:
            draw_crowd(options.out, crowd)
        except DrawingError as error:
            raise UsageError(f"--out: {error}") from None
        print(options.out, file=sys.stderr if options.json else sys.stdout)
    return exit_codes.FAILED if report.warnings else exit_codes.OK


def convert(options: Namespace) -> int:
    """Write a recording in another format; returns the exit code."""
    try:
        crowd = read_crowd(
            options.recording,
            options.fps,
            unit=options.unit,
            scale=options.scale,
            strict=options.strict,
            columns=options.columns or (),
        )
        tell_recording(options.prog, str(options.recording), crowd.report)
        write_crowd(options.out, crowd, _provenance(options, crowd), options.hz)
    except (RecordingError, WritingError) as error:
        raise UsageError(str(error)) from None
    print(options.out)
    return exit_codes.OK


def _provenance(options: Namespace, crowd: Crowd) -> dict[str, str]:
    """Where a written recording comes from."""
    given = {name: getattr(options, name) for name in ("fps", "unit", "scale", "columns", "hz")}
    told = "".join(f" --{name} {value}" for name, value in given.items() if value is not None)
    return {
        "written by": f"esplanade {__version__}, {options.prog}{told}",
        "source": options.recording.name,
        "source sha256": _digest(options.recording),
        "read as": "" if crowd.report is None else crowd.report.line,
    }


def _digest(path: Path) -> str:
    """SHA-256 of a file, or of the files of a folder in the order of their names."""
    files = sorted(part for part in path.iterdir() if part.is_file()) if path.is_dir() else [path]
    digest = hashlib.sha256()
    for file in files:
        with file.open("rb") as opened:
            while piece := opened.read(2**20):
                digest.update(piece)
    return digest.hexdigest()


def figures(crowd: Crowd, report: Report) -> dict[str, Any]:
    """The figures of a recording, as JSON holds them."""
    found: dict[str, Any] = {
        name: getattr(report, name)
        for name in (
            *("format", "rate", "unit", "people", "samples", "seconds", "sample_s"),
            *("median_mps", "greatest_mps", "passed_over", "remarks", "warnings"),
        )
    }
    found["bounds_m"] = crowd.bounds
    found["most_at_once"] = crowd.max_present
    return {
        name: None if isinstance(value, float) and not math.isfinite(value) else value
        for name, value in found.items()
    }


def _table(crowd: Crowd, report: Report) -> Table:
    x0, y0, x1, y1 = crowd.bounds
    made = Table(show_header=False)
    for name, value in (
        ("format", report.format),
        ("rate", report.rate),
        ("unit", report.unit),
        ("people", f"{report.people}, at most {crowd.max_present} at once"),
        ("time", f"{report.seconds:.6g} s from {crowd.start_s:.6g} s on"),
        ("samples", f"{report.samples}, {report.sample_s:.4g} s apart"),
        ("passed over", f"{report.passed_over} ({100 * report.share_passed_over:.2g} %)"),
        ("speed", f"median {report.median_mps:.3g} m/s, greatest {report.greatest_mps:.3g} m/s"),
        (
            "place",
            f"{x1 - x0:.4g} x {y1 - y0:.4g} m, x {x0:.4g} to {x1:.4g}, y {y0:.4g} to {y1:.4g}",
        ),
    ):
        made.add_row(name, value)
    return made
