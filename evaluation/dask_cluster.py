"""Episodes that the workers of a Dask cluster walk; the results are those of this machine.

A worker needs the same version of Esplanade, and the recordings, walls and policies at the same
paths as here; whether they are the same is compared by their digests before it walks anything.
"""

import threading
from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any, Final

from esplanade.evaluation.runner import Keep, run_part
from esplanade.evaluation.score_cache import digests_of
from esplanade.evaluation.scores import Score
from esplanade.evaluation.trials import Trial

CONNECTS_WITHIN_S: Final = 20.0

_Found = tuple[list[Score], str]
"""The scores of a chunk, and the name of the worker that has walked it."""

_one_at_a_time = threading.Lock()


class ClusterError(Exception):
    """A Dask cluster cannot be used; the message says why."""


class DaskCluster:
    """A Dask cluster by the address of its scheduler, `tcp://HOST:PORT`.

    Raises
    ------
    ClusterError
        The package is not installed, or no scheduler answers there.
    """

    def __init__(self, address: str) -> None:
        try:
            self._distributed = import_module("distributed")
        except ImportError:
            raise ClusterError(
                "--on needs the package distributed: install it, or everything of `esplanade[dask]`"
            ) from None
        try:
            self._client = self._distributed.Client(address, timeout=CONNECTS_WITHIN_S)
        except (OSError, TimeoutError) as error:
            raise ClusterError(f"--on: no scheduler answers at {address}: {error}") from None

    def close(self) -> None:
        """Leave the cluster, which goes on."""
        self._client.close()

    def run(
        self,
        parts: Sequence[tuple[int, Trial]],
        keep: Keep,
    ) -> None:
        """Let the workers walk all chunks; `keep` is called with the name of the worker of each.

        A chunk whose worker dies is walked by another one. After an interrupt, chunks that are done
        are still kept.

        Raises
        ------
        ClusterError
            A worker has other code or files, or too many died.
        """
        waiting = {
            self._client.submit(walk_part, _from_anywhere(part), digests_of(part), pure=False): (
                index,
                part,
            )
            for index, part in parts
        }
        try:
            for future in self._distributed.as_completed(list(waiting)):
                index, part = waiting.pop(future)
                scores, worker = self._result(future)
                keep(index, part, scores, worker)
        finally:
            done = [future for future in waiting if future.status == "finished"]
            self._client.cancel([future for future in waiting if future not in done])
            for future in done:
                index, part = waiting[future]
                scores, worker = future.result()
                keep(index, part, scores, worker)

    def _result(self, future: Any) -> _Found:
        try:
            found: _Found = future.result()
        except self._distributed.KilledWorker as error:
            raise ClusterError(f"--on: too many workers died: {error}") from None
        return found


def walk_part(part: Trial, expected: Mapping[str, str]) -> _Found:
    """Walk one chunk, in a worker.

    Raises
    ------
    ClusterError
        This worker has other code or files than the process that asks.
    """
    worker = import_module("distributed").get_worker().address
    try:
        found = digests_of(part)
    except OSError as error:
        raise ClusterError(f"--on: the worker {worker} lacks a file: {error}") from None
    for name, digest in expected.items():
        if found[name] != digest:
            where = "" if name == "code" else f" ({_file_of(part, name)})"
            raise ClusterError(f"--on: the worker {worker} has another {name}{where}")
    with _one_at_a_time:  # workers may have several threads, and one policy is kept in a process
        return run_part(part), worker


def _from_anywhere(part: Trial) -> Trial:
    """The same chunk with whole paths, for a process that works in another folder."""
    source, policy = part.source, part.policy
    walls = None if source.walls is None else source.walls.resolve()
    file, colon, name = policy.rpartition(":")
    if file.endswith(".py"):
        policy = f"{Path(file).resolve()}{colon}{name}"
    source = replace(source, path=source.path.resolve(), walls=walls)
    return replace(part, source=source, policy=policy)


def _file_of(part: Trial, name: str) -> str:
    return part.policy if name == "policy" else str(part.source.path)
