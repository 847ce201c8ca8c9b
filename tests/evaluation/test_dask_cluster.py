"""A Dask cluster walks the same episodes, bit for bit, though a worker is killed."""

import json
import subprocess
import sys
from dataclasses import asdict, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from esplanade.cli import main
from esplanade.evaluation.runner import run_trials
from tests.evaluation.test_runner import planned
from tests.evaluation.worlds import busy_plaza, write_csv
from tests.patience import COMPILING_PATIENCE_S

ROOT = Path(__file__).parents[2]
needs_dask = pytest.mark.skipif(find_spec("distributed") is None, reason="distributed is absent")


@pytest.fixture(scope="module")
def walks(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The results of walks on a scheduler and three workers, processes of this machine."""
    folder = tmp_path_factory.mktemp("dask")
    told = folder / "told.json"
    command = [sys.executable, "-m", "tests.evaluation.dask_walks", str(folder), str(told)]
    done = subprocess.run(
        command,
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=COMPILING_PATIENCE_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    found: dict[str, Any] = json.loads(told.read_text())
    return found


@needs_dask
def test_the_results_are_the_same_though_a_worker_is_killed(
    tmp_path: Path, walks: dict[str, Any]
) -> None:
    trials = planned(tmp_path, "straight", "human")
    found = walks["killed"]
    assert found["killed"] == 1
    for one, theirs in zip(run_trials(trials, 1, lambda _: None), found["scores"], strict=True):
        for score, other in zip(one.scores, theirs, strict=True):
            timeless = {"decision_ms": 0.0, "decision_max_ms": 0.0}
            expected = asdict(replace(score, **timeless))
            # As text, since what was not measured is nan, which equals nothing.
            assert json.dumps({**other, **timeless}) == json.dumps(expected)
    assert len(found["workers"]) == sum(len(trial.episodes) for trial in trials)
    assert all(worker.startswith("tcp://") for worker in found["workers"])


@needs_dask
def test_an_interrupted_run_goes_on_where_it_was(walks: dict[str, Any]) -> None:
    found = walks["interrupted"]
    assert found["kept"] > 0
    assert found["reports"][0] == found["kept"]
    assert sum(found["reports"]) == found["episodes"]


@needs_dask
def test_the_command_walks_on_a_cluster(walks: dict[str, Any]) -> None:
    assert walks["commanded"]["code"] == 0
    assert len(walks["commanded"]["episodes"]) == 4


@needs_dask
def test_a_worker_with_other_code_is_named(walks: dict[str, Any]) -> None:
    said = walks["other_code"]
    assert said.startswith("--on: the worker tcp://")
    assert said.endswith(" has another code")


@needs_dask
def test_a_scheduler_that_does_not_answer_is_named(tmp_path: Path) -> None:
    recording = write_csv(tmp_path, busy_plaza())
    words = ["evaluate", str(recording), "--policy", "straight", "--on", "dask://127.0.0.1:1"]
    done = subprocess.run(
        [sys.executable, "-m", "esplanade", *words],
        capture_output=True,
        text=True,
        timeout=COMPILING_PATIENCE_S,
        check=False,
    )
    assert done.returncode == 2
    assert "--on: no scheduler answers at tcp://127.0.0.1:1" in done.stderr


@pytest.mark.parametrize("address", ["127.0.0.1:8786", "dask://127.0.0.1", "dask://h:99999"])
def test_an_address_that_cannot_be_is_refused(
    address: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recording = write_csv(tmp_path, busy_plaza())
    with pytest.raises(SystemExit) as ended:
        main(["evaluate", str(recording), "--on", address])
    assert ended.value.code == 2
    assert f"{address!r} is not like dask://127.0.0.1:8786" in capsys.readouterr().err
