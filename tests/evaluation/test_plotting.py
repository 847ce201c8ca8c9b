"""Pictures of episodes."""

from importlib.util import find_spec
from pathlib import Path

import pytest

from esplanade.evaluation import plotting
from esplanade.evaluation.policies import PolicyError, make_policy
from esplanade.evaluation.simulation import run_episode
from esplanade.recordings import Obstacles
from tests.evaluation.worlds import RULES, environment, trip, walk

HEDGE = Obstacles(segments=(((5.0, -3.0), (5.0, -1.0)),), circles=((8.0, 1.0, 0.3),))


@pytest.mark.skipif(find_spec("matplotlib") is None, reason="matplotlib is absent")
@pytest.mark.parametrize("policy", ["esplanade", "straight"])
def test_an_episode_is_drawn_as_it_ran(policy: str, tmp_path: Path) -> None:
    place = environment(
        walk("1", 0.0, (0, 0), (10, 0)), walk("2", 0.0, (10, 0), (-2, 0)), obstacles=HEDGE
    )
    walker, path = make_policy(policy), tmp_path / "strip.png"
    score = plotting.draw_episode(path, "plaza", place, trip(place.replay), walker, RULES)
    assert path.read_bytes().startswith(b"\x89PNG")
    assert path.stat().st_size > 20_000
    again = run_episode(place, trip(place.replay), walker, RULES).score
    assert (score.time_s, score.clearance_m) == (again.time_s, again.clearance_m)


def test_without_matplotlib_it_says_what_helps(monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(module: str) -> object:
        raise ImportError(module)

    monkeypatch.setattr(plotting, "import_module", absent)
    with pytest.raises(PolicyError, match=r"plots need matplotlib: install it, or .*evaluate"):
        plotting.require_matplotlib()
