"""The values of options: bodies, points and numbers."""

import argparse

import pytest

from esplanade.commandline.errors import UsageError
from esplanade.planning.scene.bodies import Body
from esplanade.scenery import bodies, values
from esplanade.scenery.bodies import made_body
from esplanade.scenery.values import body, point, where


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("adult", Body.adult()),
        ("child", Body.child()),
        ("child,height=1.1", Body(0.20, 1.10, 0.30, 0.65, 64)),
        ("height=1.9,step=0.4,edge=12", Body(0.25, 1.90, 0.40, 0.90, 12)),
        ("radius=0.3,leg=0.8", Body(0.30, 1.80, 0.60, 0.80, 64)),
    ],
)
def test_a_body_is_a_preset_or_its_measures(text: str, meant: Body) -> None:
    assert made_body(body(text)) == meant


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("giant", "'giant' is no body; there are adult, child"),
        ("adult,width=1", "'width' is no measure; there are radius, height, step, leg, edge"),
        ("height=tall", "height: 'tall' is no number"),
        ("edge=2.5", "edge: '2.5' is no number"),
    ],
)
def test_text_that_is_no_body_is_refused(text: str, message: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match=message):
        body(text)


def test_two_commas_make_a_point_and_everything_else_is_a_name() -> None:
    assert where("1,2.5,-3") == (1.0, 2.5, -3.0)
    assert where("gate, north") == "gate, north"


@pytest.mark.parametrize("text", ["1,2", "1,2,x", "1,2,3,4", "1,2,inf", "nan,1,1"])
def test_text_that_is_no_point_is_refused(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError):
        point(text)


@pytest.mark.parametrize(
    ("text", "message"), [("height=-1", "height_m must lie between"), ("step=1.1", "leg_length_m")]
)
def test_what_no_body_can_measure_is_refused(text: str, message: str) -> None:
    with pytest.raises(UsageError, match=f"--body: .*{message}"):
        made_body(body(text))


def test_every_preset_has_a_body() -> None:
    """The command line knows their names without importing them."""
    assert tuple(bodies.PRESETS) == values.PRESETS
