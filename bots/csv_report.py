"""The course of a run as CSV, a line for each stretch of time."""

import csv
from pathlib import Path

from esplanade.bots.figures import Moment, SeriesFigures


def write_csv(path: Path, series: SeriesFigures) -> None:
    """Write the series; a cell is empty where nothing was measured. Raises OSError."""
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(Moment.model_fields)
        rows.writerows(
            ["" if value is None else value for value in moment.model_dump().values()]
            for moment in series.moments
        )
