import pytest

from esplanade.server.link.link import LinkFullError, ZoneEnd, ZoneLink
from esplanade.server.link.local import MAX_WAITING, LocalLink
from esplanade.server.world.inputs import Say
from tests.server.worlds import Trial


def test_inputs_go_up_and_frames_come_down_in_order_and_once() -> None:
    trial, link = Trial(), LocalLink()
    ours: ZoneLink = link
    theirs: ZoneEnd = link
    ours.send([Say(1, "a"), Say(2, "b")])
    ours.send([Say(1, "c")])
    assert theirs.inputs() == [Say(1, "a"), Say(2, "b"), Say(1, "c")]
    assert theirs.inputs() == []
    frames = [trial.frame(), trial.frame()]
    for frame in frames:
        theirs.publish(frame)
    assert ours.frames() == frames
    assert ours.frames() == []


def test_a_link_that_nobody_empties_is_full() -> None:
    trial, link = Trial(), LocalLink()
    for _ in range(MAX_WAITING):
        link.send([])
        link.publish(trial.frame())
    with pytest.raises(LinkFullError, match="inputs"):
        link.send([])
    with pytest.raises(LinkFullError, match="frames"):
        link.publish(trial.frame())
