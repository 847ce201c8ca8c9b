"""A Dask cluster walks the same episodes, bit for bit, though a worker is killed."""

import json
import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from esplanade.cli import main
from esplanade.evaluation import score_cache as score_caches
from esplanade.evaluation.dask_cluster import ClusterError, DaskCluster
from esplanade.evaluation.runner import run_trials
from esplanade.evaluation.score_cache import ScoreCache
from tests.evaluation.test_runner import planned, timeless
from tests.evaluation.worlds import busy_plaza, write_csv

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def local() -> Iterator[Any]:
    """A scheduler and three workers, processes of this machine."""
    with distributed.LocalCluster(
        n_workers=3, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster:
        yield cluster


@pytest.fixture
def cluster(local: Any) -> Iterator[DaskCluster]:
    joined = DaskCluster(local.scheduler_address)
    yield joined
    joined.close()


def a_worker(local: Any) -> int:
    """The number of the process of a worker."""
    with distributed.Client(local.scheduler_address, set_as_default=False) as client:
        pids: list[int] = list(client.run(os.getpid).values())
    return pids[0]


def test_the_results_are_the_same_though_a_worker_is_killed(
    tmp_path: Path, local: Any, cluster: DaskCluster
) -> None:
    trials = planned(tmp_path, "straight", "human")
    alone = run_trials(trials, 1, lambda _: None)
    victim = a_worker(local)
    killed: list[int] = []

    def kill_one(_: int) -> None:
        if not killed:
            os.kill(victim, signal.SIGKILL)
            killed.append(victim)

    path = tmp_path / "done.jsonl"
    with ScoreCache(path) as score_cache:
        spread = run_trials(trials, 1, kill_one, score_cache, cluster=cluster)
    assert killed
    for one, two in zip(alone, spread, strict=True):
        assert timeless(one.scores) == timeless(two.scores)
    workers = [json.loads(line)["worker"] for line in path.read_text().splitlines()]
    assert len(workers) == sum(len(trial.episodes) for trial in trials)
    assert all(worker.startswith("tcp://") for worker in workers)


def test_an_interrupted_run_goes_on_where_it_was(tmp_path: Path, cluster: DaskCluster) -> None:
    trials = planned(tmp_path, "straight")
    path = tmp_path / "done.jsonl"

    def interrupt(done: int) -> None:
        if done:
            raise KeyboardInterrupt

    with ScoreCache(path) as score_cache, pytest.raises(KeyboardInterrupt):
        run_trials(trials, 1, interrupt, score_cache, cluster=cluster)
    kept = len(path.read_text().splitlines())
    assert kept > 0
    reports: list[int] = []
    with ScoreCache(path) as score_cache:
        run_trials(trials, 1, reports.append, score_cache, cluster=cluster)
    assert reports[0] == kept
    assert sum(reports) == len(trials[0].episodes)


def test_the_command_walks_on_a_cluster(
    tmp_path: Path, local: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_csv(tmp_path, busy_plaza())
    monkeypatch.chdir(tmp_path)  # the workers have another folder
    (recording,) = tmp_path.glob("*.csv")
    address = local.scheduler_address.replace("tcp://", "dask://")
    told = ["--policy", "straight", "--episodes", "4", "--json", "out.json", "--on", address]
    assert main(["evaluate", recording.name, *told]) == 0
    assert len(json.loads((tmp_path / "out.json").read_text())["episodes"]) == 4


def test_a_worker_with_other_code_is_named(
    tmp_path: Path, cluster: DaskCluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    trials = planned(tmp_path, "straight")
    monkeypatch.setattr(score_caches, "_code_digest", lambda: "changed")
    with pytest.raises(ClusterError, match=r"the worker tcp://\S+ has another code"):
        run_trials(trials, 1, lambda _: None, cluster=cluster)


def test_a_scheduler_that_does_not_answer_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("esplanade.evaluation.dask_cluster.CONNECTS_WITHIN_S", 1.0)
    recording = write_csv(tmp_path, busy_plaza())
    told = ["--policy", "straight", "--on", "dask://127.0.0.1:1"]
    assert main(["evaluate", str(recording), *told]) == 2
    assert "--on: no scheduler answers at tcp://127.0.0.1:1" in capsys.readouterr().err


@pytest.mark.parametrize("address", ["127.0.0.1:8786", "dask://127.0.0.1", "dask://h:99999"])
def test_an_address_that_cannot_be_is_refused(
    address: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recording = write_csv(tmp_path, busy_plaza())
    with pytest.raises(SystemExit) as ended:
        main(["evaluate", str(recording), "--on", address])
    assert ended.value.code == 2
    assert f"{address!r} is not like dask://127.0.0.1:8786" in capsys.readouterr().err
