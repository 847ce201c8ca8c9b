"""Guides tell their tour to those whom they lead, and to nobody else."""

from esplanade.protocol import decode_server
from esplanade.protocol.messages import Plan, Tour
from esplanade.server.world.inputs import Watch
from tests.server.populated import HALL, Populated, spec

WEST = HALL.place("west")
TOUR = {"kind": "guide", "tour": ["west", "east"], "pause_s": 4.0}


def test_those_who_are_led_hear_the_guide_and_others_do_not() -> None:
    x, y = WEST.position
    world = Populated([spec(1, "guide", behaviour=TOUR, place=(x, y, 0.0))])
    world.frames(2)
    guide = world.zone.avatar_of("main/a1")
    assert guide is not None
    ann, ben = world.join((x + 1.5, y), (x + 5.0, y))
    heard = []
    for _ in range(140):
        for each in world.news().chat:
            assert (each.line.id, each.name) == (guide, "A1")
            assert each.viewers == [ann]
            heard.append(each.line.text)
    assert heard == [
        "Welcome to the tour of 2 stops.",
        "This is west, stop 1 of 2.",
        "We go on to east.",
    ]
    assert ben in world.audience.seen_by(guide)


def test_whoever_watches_a_guide_is_told_of_its_tour() -> None:
    x, y = WEST.position
    world = Populated([spec(1, "guide", behaviour=TOUR, place=(x, y, 0.0)), spec(2, "idle")])
    world.frames(2)
    guide, idler = (world.zone.avatar_of(f"main/a{k}") for k in (1, 2))
    (ann,) = world.join((x + 1.5, y))
    tours = {}
    for actor in (guide, idler):
        world.frame(Watch(ann, actor))
        for frame in world.frames(45):
            for packed in frame.events.plans.values():
                plan = decode_server(packed)
                assert isinstance(plan, Plan)
                tours[plan.id] = plan.tour
    assert tours == {guide: Tour(stops=["west", "east"], next=0, followers=[ann]), idler: None}
