"""Parts of the site of `make docs` beside the pages of docs/: a first page and the reference.

MkDocs calls the functions `on_…` by their names.
"""

import re
from pathlib import Path
from typing import Any, Final

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

ROOT: Final = Path(__file__).resolve().parents[1]
REFERENCE: Final = {
    "planning": ("Planning", ["esplanade.planning"]),
    "actors": ("Actors", ["esplanade.actors"]),
    "recordings": ("Recordings", ["esplanade.recordings"]),
    "policies": ("Policies of your own", ["esplanade.policies.interface"]),
    "learning": (
        "Environments for learners",
        ["esplanade.evaluation.learning.trips", "esplanade.evaluation.learning.crowds"],
    ),
    "stats": ("Statistics", ["esplanade.stats"]),
    "bots": ("Bots", ["esplanade.bots"]),
    "operators": ("Operators", ["esplanade.operators"]),
}
"""The pages of the reference: their titles, and the modules on each."""
_LINK: Final = re.compile(r"\[([^\]]+)\]\(([^)#:]+)(#[^)]*)?\)")
_DOCS: Final = "docs/"


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """Add the pages that are made here, and the files that pages link to."""
    made = {"index.md": (ROOT / "README.md").read_text()}
    for name, (title, modules) in REFERENCE.items():
        blocks = "\n\n".join(f"::: {module}" for module in modules)
        made[f"reference/{name}.md"] = f"# {title}\n\n{blocks}\n"
    for name, content in made.items():
        files.append(File.generated(config, name, content=content))
    pages = {"": made["index.md"], **{f.name: f.read_text() for f in (ROOT / _DOCS).glob("*.md")}}
    targets = {
        _target(page, link) for page, text in pages.items() for _, link, _ in _LINK.findall(text)
    }
    for target in sorted(targets):
        if not target.startswith(_DOCS) and (ROOT / target).is_file():
            copied = File.generated(config, f"files/{target}.txt", abs_src_path=str(ROOT / target))
            files.append(copied)
    return files


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Let links lead to pages of the site, and to its copies of files of the project."""
    name = page.file.src_uri
    if name.startswith("reference/"):
        return markdown

    def changed(link: re.Match[str]) -> str:
        text, path, anchor = link.groups()
        target = _target("" if name == "index.md" else name, path)
        if target.startswith(_DOCS):
            return f"[{text}]({target.removeprefix(_DOCS)}{anchor or ''})"
        return f"[{text}](files/{target}.txt)" if (ROOT / target).is_file() else text

    return _LINK.sub(changed, markdown)


def _target(page: str, link: str) -> str:
    """The path of what a page of docs/, or the README (an empty name), links to, from the top."""
    return link.removeprefix("../") if link.startswith("../") else f"{_DOCS if page else ''}{link}"
