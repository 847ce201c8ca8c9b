"""The looks of actors: what a roster or an operator says of them, and the sign of guides."""

from esplanade.actors.appearance import Appearance
from esplanade.actors.behaviour_spec import BEHAVIOUR_SPEC
from esplanade.protocol.looks import CHOSEN, MOST, NO_LOOK, Look
from esplanade.server.checkpoint.format import packed, parts_of
from esplanade.server.world.inputs import ChangeBehaviour, SendActors
from tests.server.populated import Populated, adding, spec

TOUR = {"kind": "guide", "tour": ["west", "east"], "pause_s": 60.0}


def look(world: Populated, actor: str) -> Look:
    avatar = world.zone.avatar_of(actor)
    assert avatar is not None
    return world.zone.state.look(avatar)


def test_an_appearance_has_the_parts_of_a_look_and_their_numbers() -> None:
    parts = Appearance.model_json_schema()["properties"]
    assert tuple(parts) == CHOSEN[:-1]  # stature is a parameter of actors
    assert [part["maximum"] for part in parts.values()] == list(MOST)[: len(parts)]


def test_actors_wear_what_is_said_and_guides_carry_a_sign() -> None:
    world = Populated(
        [spec(1, "guide", behaviour=TOUR), spec(2, look={"shirt": 4, "hair": 2}), spec(3, "idle")]
    )
    world.frames(2)
    assert look(world, "main/a1") == Look(sign=1)
    assert look(world, "main/a2") == Look(shirt=4, hair=2)
    assert look(world, "main/a3") == NO_LOOK
    world.frame(adding(1, spec(4, "guide", behaviour=TOUR, look={"shirt": 3})))
    assert look(world, "main/a4") == Look(shirt=3, sign=1)
    world.population.close()


def test_who_becomes_a_guide_is_seen_to_be_one_from_then_on() -> None:
    world = Populated([spec(1, look={"skin": 5})])
    world.frames(2)
    frame = world.frame(ChangeBehaviour(1, ("main/a1",), BEHAVIOUR_SPEC.validate_python(TOUR)))
    (reshaped,) = frame.reshaped
    assert reshaped.look == look(world, "main/a1") == Look(skin=5, sign=1)
    world.frame(SendActors(2, ("main/a1",), (12.0, 7.0, 0.0)))
    assert look(world, "main/a1") == Look(skin=5)
    world.population.close()


def test_looks_of_actors_outlive_a_restart_and_come_along_bit_for_bit() -> None:
    specs = [spec(1, "guide", behaviour=TOUR), spec(2, look={"shirt": 4})]
    first = Populated(specs)
    first.frames(3)
    looks = [look(first, f"main/a{k}") for k in (1, 2)]
    again = Populated(specs)
    again.zone.load_exactly(parts_of(packed(first.zone.save_exactly())))
    assert [look(again, f"main/a{k}") for k in (1, 2)] == looks
    kept = Populated([])
    kept.zone.state.begin_ids(100, 10_000)
    kept.zone.load(first.zone.save(), [])
    kept.frames(2)
    assert [look(kept, f"main/a{k}") for k in (1, 2)] == looks
    for world in (first, again, kept):
        world.population.close()
