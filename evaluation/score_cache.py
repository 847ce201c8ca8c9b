"""A cache of scores on disk: no episode is run twice, and an interrupt loses no results."""

import hashlib
import json
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import MISSING, asdict, fields, replace
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self, TextIO

from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.scores import Score
from esplanade.evaluation.trials import Source, Trial
from esplanade.policies.names import digest_of_policy, is_outside
from esplanade.recordings import walls_beside

_ROOT: Final = Path(__file__).resolve().parents[1]
_PACKAGES: Final = ("actors", "evaluation", "pedestrians", "planning", "policies", "recordings")
_SHOW_ONLY: Final = frozenset(
    {
        "calibration",
        "cli",
        "console",
        "dask_cluster",
        "forecast_report",
        "fits",
        "forecasts",
        "options",
        "plotting",
        "report",
        "score_cache",
        "studies",
        "trajectory_files",
    }
)
"""Modules and packages of `evaluation` that no score depends on."""

_Key = tuple[str, int, bool]


class ScoreCacheError(Exception):
    """A cache file cannot be used; the message names the file and the reason."""


class ScoreCache:
    """A file with one line of JSON for each scored episode.

    A score is found again only if everything that it depends on is the same: recording, rules,
    policy, settings, episode, and the source code. Different studies may share one file, but only
    one process may use it at a time. Without a path, scores last as long as this object.

    Raises
    ------
    ScoreCacheError
        The file cannot be read or written, or holds a line of another form.
    """

    def __init__(self, path: Path | None = None) -> None:
        self._scores: dict[_Key, Score] = {}
        self._file: TextIO | None = None
        if path is None:
            return
        try:
            text = path.read_text(encoding="utf-8") if path.exists() else ""
            whole = text[: text.rfind("\n") + 1]
            self._scores |= _entries(path, whole)
            self._file = path.open("a", encoding="utf-8")
            if whole != text:  # the process that wrote the file was killed in the middle of a line
                self._file.truncate(len(whole.encode()))
        except (OSError, UnicodeDecodeError) as error:
            raise ScoreCacheError(f"{path}: {error}") from None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._file is not None:
            self._file.close()

    def find(self, trial: Trial) -> dict[int, Score]:
        """The known scores of a trial's episodes, by the numbers of these episodes."""
        digest = _digest_of(trial)
        known = ((e.number, self._scores.get((digest, *_trip(e)))) for e in trial.episodes)
        return {k: replace(score, number=k) for k, score in known if score is not None}

    def add(self, trial: Trial, scores: Sequence[Score], worker: str = "") -> None:
        """Keep the scores of a trial's episodes; they are in the file when this returns.

        `worker` names the process of a cluster that has walked them.
        """
        digest = _digest_of(trial)
        lines = []
        for episode, score in zip(trial.episodes, scores, strict=True):
            self._scores[digest, *_trip(episode)] = score
            lines.append(
                json.dumps(_line(digest, trial, episode, score, worker), allow_nan=False) + "\n"
            )
        if self._file is not None:
            try:
                self._file.write("".join(lines))
                self._file.flush()
            except OSError as error:
                raise ScoreCacheError(f"{self._file.name}: {error}") from None


def _entries(path: Path, text: str) -> dict[_Key, Score]:
    found = {}
    for number, line in enumerate(text.splitlines(), start=1):
        try:
            entry = json.loads(line)
            key = entry["trial"], entry["pedestrian"], entry["reverse"]
            found[key] = _score(entry["score"])
        except (ValueError, TypeError, KeyError):
            raise ScoreCacheError(f"{path}:{number}: this is no line of a score cache") from None
    return found


def _line(digest: str, trial: Trial, episode: Episode, score: Score, worker: str) -> dict[str, Any]:
    """The content of one line; recording, policy, settings and worker are for human readers."""
    pedestrian, reverse = _trip(episode)
    return {
        "trial": digest,
        "recording": trial.source.path.stem,
        "policy": trial.policy,
        "settings": {name: _finite(value) for name, value in trial.settings},
        "pedestrian": pedestrian,
        "reverse": reverse,
        **({"worker": worker} if worker else {}),
        "score": {name: _finite(value) for name, value in asdict(score).items()},
    }


def _trip(episode: Episode) -> tuple[int, bool]:
    """The key of an episode within its recording."""
    return episode.pedestrian, episode.reverse


def _score(values: dict[str, Any]) -> Score:
    known = {field.name: field.default is not MISSING for field in fields(Score)}
    if not values.keys() <= known.keys() or not all(
        name in values or optional for name, optional in known.items()
    ):
        raise ValueError("the score has other fields")
    given: dict[str, Any] = {k: math.nan if v is None else v for k, v in values.items()}
    return Score(**given)


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _digest_of(trial: Trial) -> str:
    """A digest of everything that the scores of a trial depend on, except the episode."""
    settings = sorted((name, repr(value)) for name, value in trial.settings)
    rules = sorted(asdict(trial.rules).items())
    files = digests_of(trial)
    code = files["code"], files["policy"]
    inputs = repr((code, files["recording"], trial.policy, rules, settings))
    return hashlib.sha256(inputs.encode()).hexdigest()[:16]


def digests_of(trial: Trial) -> dict[str, str]:
    """Digests of all files that the scores of a trial depend on.

    They are of the `code`, the `recording` with its walls, and the `policy`, empty for one of ours.

    Raises
    ------
    OSError
        A file cannot be read.
    """
    return {
        "code": _code_digest(),
        "recording": _recording_digest(trial.source),
        "policy": digest_of_policy(trial.policy) if is_outside(trial.policy) else "",
    }


@cache
def _recording_digest(source: Source) -> str:
    """A digest of the recording, its walls, and how they are read."""
    walls = source.walls or walls_beside(source.path)
    how = repr((source.path.suffix, tuple(source.given), source.interpolation)).encode()
    read = source.digest(), _digest_of_bytes(b"" if walls is None else walls.read_bytes())
    return _joined([*read, _digest_of_bytes(how)])


@cache
def _code_digest() -> str:
    """A digest of the source code that scores depend on.

    It is cached because the code that runs is the code that was imported.
    """
    return _joined(_digest_of_bytes(path.read_bytes()) for path in sorted(_sources()))


def _sources() -> Iterator[Path]:
    for package in _PACKAGES:
        for path in (_ROOT / package).rglob("*.py"):
            part = path.relative_to(_ROOT / package).parts[0].removesuffix(".py")
            if not (package == "evaluation" and part in _SHOW_ONLY):
                yield path


def _digest_of_bytes(part: bytes) -> str:
    return hashlib.sha256(part).hexdigest()


def _joined(digests: Iterable[str]) -> str:
    """The digest of parts that have these digests."""
    return _digest_of_bytes(b"".join(map(bytes.fromhex, digests)))
