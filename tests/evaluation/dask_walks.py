"""Walks episodes on a Dask cluster of this machine, in a process of its own.

    python -m tests.evaluation.dask_walks FOLDER FILE.json

It writes to the file what came of it. The library keeps threads and sockets that outlive a test;
so it stays out of the tests' process.
"""

import json
import os
import signal
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import distributed

from esplanade.cli import main
from esplanade.evaluation import score_cache as score_caches
from esplanade.evaluation.dask_cluster import ClusterError, DaskCluster
from esplanade.evaluation.runner import run_trials
from esplanade.evaluation.score_cache import ScoreCache
from tests.evaluation.test_runner import planned


def walked_though_one_is_killed(folder: Path, cluster: DaskCluster, victim: int) -> dict[str, Any]:
    killed: list[int] = []

    def kill_one(_: int) -> None:
        if not killed:
            os.kill(victim, signal.SIGKILL)
            killed.append(victim)

    path = folder / "done.jsonl"
    trials = planned(folder, "straight", "human")
    with ScoreCache(path) as score_cache:
        found = run_trials(trials, 1, kill_one, score_cache, cluster=cluster)
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    return {
        "killed": len(killed),
        "scores": [[asdict(score) for score in result.scores] for result in found],
        "workers": [line["worker"] for line in lines],
    }


def interrupted(folder: Path, cluster: DaskCluster) -> dict[str, Any]:
    trials, path = planned(folder, "straight"), folder / "interrupted.jsonl"

    def interrupt(done: int) -> None:
        if done:
            raise KeyboardInterrupt

    try:
        with ScoreCache(path) as score_cache:
            run_trials(trials, 1, interrupt, score_cache, cluster=cluster)
    except KeyboardInterrupt:
        pass
    kept = len(path.read_text().splitlines())
    reports: list[int] = []
    with ScoreCache(path) as score_cache:
        run_trials(trials, 1, reports.append, score_cache, cluster=cluster)
    return {"kept": kept, "reports": reports, "episodes": len(trials[0].episodes)}


def commanded(folder: Path, address: str) -> dict[str, Any]:
    (recording,) = folder.glob("*.csv")
    before = Path.cwd()
    os.chdir(folder)  # the workers have another folder
    told = ["--policy", "straight", "--episodes", "4", "--json", "out.json"]
    at = address.replace("tcp://", "dask://")
    code = main(["evaluate", recording.name, *told, "--on", at])
    os.chdir(before)
    return {"code": code, "episodes": json.loads((folder / "out.json").read_text())["episodes"]}


def with_other_code(folder: Path, cluster: DaskCluster) -> str:
    score_caches._code_digest = lambda: "changed"
    try:
        run_trials(planned(folder, "straight"), 1, lambda _: None, cluster=cluster)
    except ClusterError as error:
        return str(error)
    return "nothing was said"


def walk(folder: Path) -> dict[str, Any]:
    with distributed.LocalCluster(
        n_workers=3, threads_per_worker=1, processes=True, dashboard_address=None
    ) as local:
        address = local.scheduler_address
        with distributed.Client(address, set_as_default=False) as client:
            victim = next(iter(client.run(os.getpid).values()))
        cluster = DaskCluster(address)
        found = {
            "killed": walked_though_one_is_killed(folder, cluster, victim),
            "interrupted": interrupted(folder, cluster),
            "commanded": commanded(folder, address),
            "other_code": with_other_code(folder, cluster),
        }
        cluster.close()
    return found


if __name__ == "__main__":
    walks = walk(Path(sys.argv[1]))
    Path(sys.argv[2]).write_text(json.dumps(walks))
