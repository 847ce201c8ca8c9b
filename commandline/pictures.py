"""The form of pictures: every one can be PNG, SVG or PDF."""

from pathlib import Path
from typing import Any, Final

PICTURES: Final = ("png", "svg", "pdf")
SUFFIXES: Final = tuple(f".{form}" for form in PICTURES)
_DATES: Final[dict[str, dict[str, Any]]] = {
    ".svg": {"Date": None},
    ".pdf": {"CreationDate": None},
}


def add_picture(parser: Any, default: str = "png") -> None:
    """Add `--picture`, for commands that name their pictures themselves."""
    parser.add_argument(
        "--picture",
        choices=PICTURES,
        default=default,
        help=f"form of the pictures; svg and pdf are for papers [default: {default}]",
    )


def save(figure: Any, path: Path, **more: Any) -> None:
    """Write a figure of matplotlib without the time of day: the same figure is the same file."""
    figure.savefig(path, metadata=_DATES.get(path.suffix.lower()), **more)
