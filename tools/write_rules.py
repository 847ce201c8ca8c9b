"""Write docs/rules.md: every number of the rules of planning, with unit, range and effect.

python tools/write_rules.py
"""

from itertools import groupby
from pathlib import Path

from esplanade.planning import RuleModel

OUT = Path(__file__).resolve().parents[1] / "docs" / "rules.md"
HEAD = """\
# Rules of planning

The numbers by which all actors of a zone plan among people and among each other
([planning](planning.md)). They are fields of `RuleModel` in `planning/agents/rules.py`, which
holds them to their ranges; kernels look them up in one record. What two actors may differ in,
body and temper, are fields of `ActorParameters` in `actors/parameters.py`, and operators tune
those in a running world. These here stay as they are while a world runs: two who meet have to
keep to the same rules.

`esplanade evaluate --set rules.NAME=VALUE`, `--sensitivity --vary`, `--tune` and
`Navigator(rules=RuleModel(...))` change them. `python tools/write_rules.py` writes this page.
"""


def page() -> str:
    """The whole page."""
    fields = RuleModel.model_json_schema()["properties"].items()
    parts = [HEAD]
    for group, rules in groupby(fields, key=lambda item: item[1]["group"]):
        parts.append(
            f"\n## {group.capitalize()}\n\n| rule | default | range | effect |\n|---|---|---|---|\n"
        )
        parts.extend(row(name, field) for name, field in rules)
    return "".join(parts)


def row(name: str, field: dict[str, object]) -> str:
    """One line of a table."""
    if field["type"] == "boolean":
        default = "yes" if field["default"] else "no"
        return f"| `{name}` | {default} | yes or no | {field['description']} |\n"
    unit = "" if field["unit"] == "1" else f" {field['unit']}"
    default, least, most = (f"{field[key]:g}" for key in ("default", "minimum", "maximum"))
    return f"| `{name}` | {default}{unit} | {least} to {most} | {field['description']} |\n"


if __name__ == "__main__":
    OUT.write_text(page())
