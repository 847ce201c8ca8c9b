"""Write protocol/asyncapi.json: the protocol as an AsyncAPI document, made of its models.

python tools/write_asyncapi.py
"""

import json
from pathlib import Path

from esplanade.protocol.described import document

OUT = Path(__file__).resolve().parents[1] / "protocol" / "asyncapi.json"


def text() -> str:
    """The whole file."""
    return json.dumps(document(), indent=1, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    OUT.write_text(text(), encoding="utf-8")
