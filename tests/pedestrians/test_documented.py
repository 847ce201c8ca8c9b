"""The example for researchers runs as it is written."""

from pathlib import Path
from typing import Any

import pytest

from tests.evaluation.worlds import crowd, walk, write_csv
from tests.test_docs import ROOT, blocks


def test_the_documented_example_imposes_what_it_prints(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_csv(tmp_path, crowd(walk("1", 55.0, (12.0, 5.2), (-6.0, 5.2))), "zara1")
    monkeypatch.chdir(tmp_path)
    (example,) = blocks((ROOT / "docs/evaluation.md").read_text(), "python")
    names: dict[str, Any] = {}
    exec(example, names)
    assert names["walk"].displacement_m[0] > 0.2
    assert capsys.readouterr().out.endswith("m imposed on 1 people\n")
