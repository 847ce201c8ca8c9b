"""The public recordings, for tests that need real crowds.

They are not ours to hand out: anyone can make them from the public repository
crowdbotp/OpenTraj. Point `ESPLANADE_RECORDINGS` at the folder that holds `crowds/*.csv`.
"""

import os
from pathlib import Path

import pytest

_PROJECT = Path(__file__).resolve().parents[2]
_DATA = Path(os.environ.get("ESPLANADE_RECORDINGS", _PROJECT.parent / "shared" / "data"))


def recorded(name: str) -> Path:
    """Path of a recorded crowd such as "zara1"; skips the test where it is absent."""
    path = _DATA / "crowds" / f"{name}.csv"
    if not path.is_file():
        pytest.skip(f"recorded crowd {name}.csv is absent; set ESPLANADE_RECORDINGS to its folder")
    return path
