"""The exact state of a zone: nothing of those who have gone is left in it."""

from esplanade.server.checkpoint.format import packed, parts_of
from esplanade.server.recording.digests import differences
from esplanade.server.world.inputs import Follow, Join, Leave
from tests.server.populated import Populated


def test_a_newcomer_has_nothing_of_whoever_had_the_slot_before() -> None:
    first = Populated([])
    (ann,) = first.join((3.0, 3.0))
    first.frame(Follow(ann, 1, ((3.5, 3.0, 0.0), (5.0, 3.0, 0.0))))
    first.frames(3)
    first.frame(Leave(ann))
    second = Populated([])
    second.zone.load_exactly(parts_of(packed(first.zone.save_exactly())))
    states = []
    for world in (first, second):
        world.frame(Join(9, "Ben", (3.0, 3.0, 0.0)))
        states.append(parts_of(packed(world.zone.save_exactly())))
        world.population.close()
    assert differences(*states) == []
