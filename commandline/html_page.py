"""One HTML page that needs nothing else: its style, its tables, and what is drawn in it."""

from collections.abc import Iterable, Sequence
from html import escape
from importlib import resources


def page(title: str, parts: Iterable[str]) -> str:
    """The whole page; its parts are HTML."""
    style = resources.files("esplanade.commandline").joinpath("html_page.css").read_text("utf-8")
    return "\n".join(
        [
            '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{escape(title)}</title>\n<style>\n{style}</style>",
            "</head>\n<body>",
            f"<h1>{escape(title)}</h1>",
            *parts,
            "</body>\n</html>\n",
        ]
    )


def table(title: str, heads: Iterable[str], rows: Iterable[Sequence[str]]) -> str:
    """A table with a heading above it, which can be moved sideways where it is too wide."""
    head = "".join(f"<th>{escape(each)}</th>" for each in heads)
    body = "\n".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows
    )
    return (
        f'<section><h2>{escape(title)}</h2><div class="wide"><table>\n'
        f"<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div></section>"
    )
