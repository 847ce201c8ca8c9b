"""The tables of an evaluation as a file: CSV, LaTeX, or one HTML page with plots."""

import csv
import io
import math
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Final

from esplanade.commandline.errors import UsageError
from esplanade.commandline.html_page import page, table
from esplanade.evaluation.interval_plot import draw
from esplanade.evaluation.tables import Table

_HEADS: Final = ("table", "figure", "policy", "value", "low", "high", "differs")
_LATEX: Final = str.maketrans(
    {
        "\\": r"\textbackslash{}",
        "~": r"\textasciitilde{}",
        "^": r"\textasciicircum{}",
        "²": r"\textsuperscript{2}",
        **{sign: f"\\{sign}" for sign in "&%$#_{}"},
    }
)


def write(path: Path, tables: Sequence[Table], command: str) -> None:
    """Write all tables in the form that the file's suffix names, and the command that repeats them.

    Raises
    ------
    UsageError
        The file cannot be written.
    """
    text = {".csv": _csv, ".tex": _latex, ".html": _html}[path.suffix](tables, command)
    try:
        path.write_text(text, encoding="utf-8", newline="")
    except OSError as error:
        raise UsageError(f"--report: {error}") from None


def _csv(tables: Sequence[Table], _: str) -> str:
    """A row for each figure; a field is empty where nothing is known."""
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(_HEADS)
    for found in tables:
        for heading, cells in found.rows:
            for policy, cell in zip(found.policies, cells, strict=True):
                low, high = cell.interval or (math.nan, math.nan)
                values = ("" if math.isnan(v) else repr(v) for v in (cell.value, low, high))
                differs = "" if cell.differs is None else str(cell.differs).lower()
                writer.writerow((found.title, heading.strip(), policy, *values, differs))
    return text.getvalue()


def _latex(tables: Sequence[Table], command: str) -> str:
    """Tables of the package booktabs."""
    parts = [f"% {command}"]
    for found in tables:
        columns = "l" + "r" * len(found.policies)
        heads = " & ".join(["", *map(_escaped, found.policies)])
        parts += [
            "\\begin{table}\n\\centering",
            f"\\caption{{{_escaped(found.title)}}}",
            f"\\begin{{tabular}}{{{columns}}}\n\\toprule\n{heads} \\\\\n\\midrule",
            *(
                " & ".join([_escaped(heading), *(_escaped(cell.text) for cell in cells)]) + " \\\\"
                for heading, cells in found.rows
            ),
            "\\bottomrule\n\\end{tabular}\n\\end{table}",
        ]
    return "\n".join(parts) + "\n"


def _escaped(text: str) -> str:
    indent = r"\quad " if text.startswith(" ") else ""
    return indent + text.strip().translate(_LATEX)


def _html(tables: Sequence[Table], command: str) -> str:
    parts = [f"<p><code>{escape(command)}</code></p>"]
    for found in tables:
        rows = [(heading, *(cell.text for cell in cells)) for heading, cells in found.rows]
        parts.append(table(found.title, ["", *found.policies], rows))
        plots = [draw(found.policies, *row) for row in found.rows if row[1][0].interval]
        figures = "".join(f"<figure>{plot}</figure>" for plot in plots)
        parts.append(
            f'<details><summary>Plots: {escape(found.title)}</summary><div class="charts">'
            f"{figures}</div></details>"
        )
    return page("Actors among recorded people", parts)
