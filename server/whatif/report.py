"""The report of a what-if: one HTML page with its table, strip and plots."""

from html import escape
from pathlib import Path

from esplanade.commandline.errors import UsageError
from esplanade.commandline.html_page import page, table
from esplanade.server.whatif.drawing import by_seed, over_time
from esplanade.server.whatif.told import HEADS, WhatIf


def write(path: Path, found: WhatIf) -> None:
    """Write the page.

    Raises
    ------
    UsageError
        The file cannot be written.
    """
    try:
        path.write_text(_page(found), encoding="utf-8")
    except OSError as error:
        raise UsageError(f"--report: {error}") from None


def _page(found: WhatIf) -> str:
    parts = [f"<p>{escape(each)}</p>" for each in found.sentences]
    parts.append(f"<p><code>{escape(found.command)}</code></p>")
    title = "Figures" if found.seeds is None else "Means over seeds (*: differs beyond chance)"
    parts.append(table(title, HEADS, [found.cells(row) for row in found.rows]))
    strips = "".join(f"<figure>{each}</figure>" for each in over_time(found.strip))
    parts.append(f'<section><h2>Over time</h2><div class="strips">{strips}</div></section>')
    if found.seeds is not None:
        plots = "".join(
            f"<figure>{by_seed(row, ' '.join(found.cells(row)[3:]))}</figure>" for row in found.rows
        )
        parts.append(
            f'<section><h2>Differences by seed</h2><div class="charts">{plots}</div></section>'
        )
    meanings = [(row.measure.label, row.measure.meaning) for row in found.rows]
    terms = "".join(f"<dt>{escape(name)}</dt><dd>{escape(text)}</dd>" for name, text in meanings)
    parts.append(f"<section><h2>What the figures mean</h2><dl>{terms}</dl></section>")
    return page(f"What if: {', '.join(found.changes.texts)}", parts)
