"""The figures of the guidelines: what a robot does to people on small, known trips."""

import cmath
import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from esplanade.cli import main
from esplanade.evaluation.conduct import Conduct, collisions, forces
from esplanade.evaluation.guideline_names import GUIDELINES
from esplanade.evaluation.guidelines import MEASURES
from esplanade.evaluation.policies.policy import Person
from esplanade.evaluation.scores import Score
from esplanade.evaluation.simulation import run_episode
from esplanade.pedestrians.model import SocialForce
from tests.evaluation.worlds import RULES, Scripted, busy_plaza, environment, trip, walk, write_csv
from tests.naive import reacting as naive

ROBOT = walk("1", 0.0, (0, 0), (10, 0))


def scored(*people: tuple[str, tuple[float, float], tuple[float, float]], **more: float) -> Score:
    """The score of a robot that walks 10 m straight on among people who walk straight on too."""
    tracks = [walk(name, 0.0, start, end, **more) for name, start, end in people]
    place = environment(ROBOT, *tracks)
    return run_episode(place, trip(place.replay), Scripted((1.3, 0.0)), RULES).score


def stands(x: float, y: float) -> tuple[tuple[float, float], tuple[float, float]]:
    return (x, y), (x, y + 0.2)


def test_alone_on_a_straight_way_all_is_as_good_as_can_be() -> None:
    score = scored()
    assert MEASURES["stl"].of(score) == pytest.approx(1.0, abs=0.12)
    assert MEASURES["spl"].of(score) == pytest.approx(1.0, abs=0.02)
    assert score.time_to_collision_s == 10.0
    assert (score.intimate_s, score.personal_s, score.social_s) == (0.0, 0.0, 0.0)
    assert score.turning_radpm == 0.0
    assert score.force_work_mps == 0.0
    assert score.groups_entered == 0
    assert score.stalled_s == 0.0
    assert score.jerk_mean_mps3 > 0.0  # it sets out


def test_who_does_not_arrive_has_no_success_to_weigh() -> None:
    place = environment(ROBOT)
    score = run_episode(place, trip(place.replay), Scripted((0.0, 0.0)), RULES).score
    assert MEASURES["spl"].of(score) == MEASURES["stl"].of(score) == 0.0
    assert score.stalled_s == pytest.approx(RULES.time_limit_s)


def test_zones_are_those_of_the_nearest_surface() -> None:
    apart = 0.5 + 1.0  # a person of 0.25 m, 1 m beside the surface of the robot
    score = scored(("2", *stands(5.0, apart)), speed_mps=0.005)
    # Within 1.2 m between surfaces on both sides of the nearest point; Pythagoras.
    half = math.sqrt(1.7**2 - apart**2)
    assert score.personal_s == pytest.approx(2.0 * half / 1.3, abs=0.25)
    assert score.intimate_s == 0.0
    wider = 2.0 * math.sqrt(4.1**2 - apart**2) / 1.3
    assert score.social_s + score.personal_s == pytest.approx(wider, abs=0.3)


def test_the_time_to_a_collision_is_that_of_straight_motion() -> None:
    score = scored(("2", (10.0, 1.0), (-2.0, 1.0)), speed_mps=1.3)
    assert score.time_to_collision_s == 10.0  # they pass half a metre from surface to surface
    meets = scored(("2", (10.0, 0.3), (-2.0, 0.3)), speed_mps=1.3)
    assert meets.time_to_collision_s == 0.0


def test_walking_between_two_who_stand_together_is_told_and_around_them_is_not() -> None:
    pair = [("2", *stands(5.0, 0.5)), ("3", *stands(5.0, -0.7))]
    assert scored(*pair, speed_mps=0.005).groups_entered == 1
    beside = [("2", *stands(5.0, 0.6)), ("3", *stands(5.0, 1.6))]
    assert scored(*beside, speed_mps=0.005).groups_entered == 0
    strangers = [("2", *stands(5.0, 0.9)), ("3", *stands(5.0, -0.9))]
    assert scored(*strangers, speed_mps=0.005).groups_entered == 0


@given(
    st.tuples(*[st.floats(-4.0, 4.0)] * 2).filter(lambda at: math.hypot(*at) > 0.6),
    st.tuples(*[st.floats(-2.0, 2.0)] * 2),
)
def test_collisions_are_those_of_small_steps(
    offset: tuple[float, float], velocity: tuple[float, float]
) -> None:
    (found,) = collisions(np.array([offset]), np.array([velocity]), 0.5)
    times = np.linspace(0.0, 12.0, 24001)
    places = np.array(offset) + times[:, None] * np.array(velocity)
    touching = np.flatnonzero(np.hypot(*places.T) <= 0.5)
    if len(touching):
        assert found == pytest.approx(times[touching[0]], abs=0.001)
    elif math.isfinite(found):  # it only just touches, or later
        nearest = np.hypot(*(np.array(offset) + found * np.array(velocity)))
        assert found > 11.9 or nearest == pytest.approx(0.5, abs=1e-3)


@given(*[st.complex_numbers(max_magnitude=2.0)] * 2, st.floats(0.3, 4.0), st.floats(-3.1, 3.1))
def test_forces_are_those_by_which_people_react(
    own: complex, other: complex, away: float, angle: float
) -> None:
    offset = cmath.rect(away, angle)
    interaction = SocialForce().velocity_share_s * (own - other) + offset / away
    assume(abs(interaction) > 1e-3)

    def plain(z: complex) -> np.ndarray:
        return np.array([z.real, z.imag])

    (found,) = forces(plain(offset)[None], plain(own)[None], plain(other)[None])
    model = SocialForce(unseen=1.0)
    twin = model.strength_mps2 * naive.evasion(model, offset, own, other, 0.0)
    assert found == pytest.approx(plain(twin), abs=1e-6)


def test_every_measure_has_its_name_definition_and_source() -> None:
    page = (Path(__file__).parents[2] / "docs" / "evaluation.md").read_text()
    assert list(MEASURES) == list(GUIDELINES)
    for measure in MEASURES.values():
        assert len(measure.definition) > 20
        assert measure.source
        assert measure.label.startswith(GUIDELINES[measure.name])
        row = f"| `{measure.name}` | {measure.unit or '1'} | {measure.definition} | "
        assert f"{row}{measure.source} |" in page


def test_the_command_adds_their_rows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recording, told = write_csv(tmp_path, busy_plaza()), tmp_path / "told.json"
    words = ["evaluate", str(recording), "--policy", "straight", "--episodes", "6"]
    assert main([*words, "--measures", "stl,groups,stalled", "--json", str(told)]) == 0
    shown = capsys.readouterr().out
    assert "success weighted by time" in shown
    assert "groups walked through" in shown
    assert "mean jerk" not in shown
    (row,) = json.loads(told.read_text())["summaries"]
    assert list(row["guidelines"]) == ["stl", "groups", "stalled"]
    assert 0.0 < row["guidelines"]["stl"]["mean"] <= 1.0
    assert row["guidelines"]["stl"]["interval"] == [None, None]  # one piece of time tells nothing
    with pytest.raises(SystemExit):
        main([*words, "--measures", "stl,joy"])
    assert "'joy' is no measure; there are spl, stl," in capsys.readouterr().err


def test_people_of_whom_too_little_is_known_are_no_group() -> None:
    conduct = Conduct(RULES)
    new = [Person(k, np.array([[1.0, y]])) for k, y in ((1, 0.4), (2, -0.4))]
    conduct.step(new, np.array([1.0, 0.0]), np.zeros(2))
    assert conduct.figures().groups_entered == 0
    assert conduct.figures().intimate_s == pytest.approx(RULES.tick_s)
