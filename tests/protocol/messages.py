"""Hypothesis strategies for every message of both directions."""

import unicodedata
from typing import Any

from hypothesis import strategies as st

from esplanade.protocol import ByeCode, ErrorCode, Kind, NoticeCode, Outcome, Reason
from esplanade.protocol.codes import (
    MAX_CHAT_CHARS,
    MAX_DOOR_CHARS,
    MAX_LINE_NUMBER,
    MAX_NAME_CHARS,
    MAX_TOKEN_CHARS,
)
from esplanade.protocol.looks import CHOSEN, MOST, SHORTEST_CM, Look
from esplanade.protocol.messages import (
    Blocker,
    Bye,
    Census,
    Chat,
    ChatLine,
    ChooseLook,
    Circle,
    Doors,
    Enter,
    Entity,
    Error,
    FromClient,
    FromServer,
    Hello,
    Hide,
    Leave,
    Move,
    MutePerson,
    Notice,
    Ping,
    Plan,
    Point,
    Pong,
    Report,
    Reshape,
    SetDoor,
    Snapshot,
    StepBlock,
    Tour,
    Travel,
    WalkTo,
    Watch,
    Welcome,
)
from esplanade.protocol.names import plain_name

u32 = st.integers(0, 0xFFFF_FFFF)
layers = st.integers(0, 255)
metres = st.floats(-100_000, 100_000, allow_nan=False)
floats = st.floats(allow_nan=False, allow_infinity=False)
texts = st.text(st.characters(codec="utf-8"), max_size=80)
bounds = st.tuples(floats, floats)
places = st.tuples(floats, floats, floats)
tokens = st.text(st.characters(codec="utf-8"), max_size=MAX_TOKEN_CHARS)
numbers = st.integers(0, MAX_LINE_NUMBER)
arguments = st.dictionaries(texts, texts | floats | st.booleans() | st.none(), max_size=3)
chosen_looks = st.builds(
    Look,
    **{name: st.integers(0, most) for name, most in zip(CHOSEN[:-1], MOST, strict=False)},
    stature_cm=st.just(0) | st.integers(SHORTEST_CM, MOST.stature_cm),
    sign=st.just(0),
)
looks = st.builds(Look._replace, chosen_looks, sign=st.integers(0, MOST.sign))
doors = st.dictionaries(texts, st.booleans(), max_size=3)


def lines(max_chars: int) -> st.SearchStrategy[str]:
    """Texts as people type them, with something to see and nothing around it."""
    inner = st.text(st.characters(categories=["L", "M", "N", "P", "S"]), max_size=max_chars - 1)
    return st.tuples(st.sampled_from("Aä漢🙂"), inner).map("".join)


def is_plain(text: str) -> bool:
    """Whether it is a name in its one way of writing."""
    try:
        return plain_name(text) == text
    except ValueError:
        return False


names = (
    st.text(st.characters(categories=["Ll", "Lu", "Lo", "Nd", "P", "S"]), min_size=1)
    .map(lambda text: unicodedata.normalize("NFKC", text)[:MAX_NAME_CHARS])
    .filter(is_plain)
)
scenes: st.SearchStrategy[dict[str, Any]] = st.dictionaries(
    texts, st.recursive(st.none() | floats | texts, st.lists, max_leaves=8)
)

client_messages: st.SearchStrategy[FromClient] = st.one_of(
    st.builds(
        Hello,
        name=names,
        version=st.integers(0, 0xFFFF),
        resume=st.none() | tokens,
        at=st.none() | st.tuples(metres, metres, metres),
        operator=st.none() | tokens,
        steps=st.booleans(),
        look=st.none() | chosen_looks,
    ),
    st.builds(Move, seq=u32, direction=st.floats(-1000, 1000), speed=st.floats(0, 100)),
    st.builds(WalkTo, seq=u32, x=metres, y=metres, z=metres),
    st.builds(ChatLine, text=lines(MAX_CHAT_CHARS)),
    st.builds(Ping, nonce=u32),
    st.builds(Watch, id=st.none() | u32),
    st.builds(
        SetDoor,
        name=st.text(st.characters(codec="utf-8"), min_size=1, max_size=MAX_DOOR_CHARS),
        open=st.booleans(),
    ),
    st.builds(Report, id=u32, line=st.none() | numbers, text=lines(MAX_CHAT_CHARS)),
    st.builds(MutePerson, id=u32, muted=st.booleans()),
    st.builds(ChooseLook, look=chosen_looks),
)

entities = st.builds(
    Entity,
    id=u32,
    kind=st.sampled_from(Kind),
    name=texts,
    layer=layers,
    x=floats,
    y=floats,
    z=floats,
    heading=floats,
    radius=floats,
    leg_m=floats,
    stature_m=floats,
    points_at=st.none() | places,
    look=looks,
)
blockers = st.builds(
    Blocker,
    kind=st.sampled_from(["person", "actor", "door", "wall", "route"]),
    id=st.none() | u32,
    door=st.none() | texts,
    away=st.none() | floats,
)
tours = st.builds(
    Tour, stops=st.lists(texts, max_size=3), next=u32, followers=st.lists(u32, max_size=3)
)
circles = st.builds(Circle, x=floats, y=floats, z=floats, radius=floats)

server_messages: st.SearchStrategy[FromServer] = st.one_of(
    st.builds(
        Welcome,
        version=st.integers(0, 0xFFFF),
        id=u32,
        name=texts,
        resume=texts,
        resumed=st.booleans(),
        scene=scenes,
        tick=u32,
        tick_rate=st.integers(1, 1000),
        server_time=floats,
        resume_seconds=floats,
        radius=floats,
        clearance=floats,
        body_height=floats,
        step_height=floats,
        max_speed=floats,
        walk_speed=floats,
        origin=bounds,
        doors=doors,
        operator=st.booleans(),
    ),
    st.builds(Enter, tick=u32, entities=st.lists(entities, max_size=4)),
    st.builds(Leave, tick=u32, ids=st.lists(u32)),
    st.builds(Snapshot, tick=u32, ack=u32, block=st.binary(max_size=400)),
    st.builds(Chat, id=u32, name=texts, text=texts, line=numbers),
    st.builds(Hide, lines=st.lists(numbers)),
    st.builds(Notice, text=texts, notice=st.sampled_from(NoticeCode), arguments=arguments),
    st.builds(Error, error=st.sampled_from(ErrorCode), text=texts, arguments=arguments),
    st.builds(Bye, reason=st.sampled_from(ByeCode), text=texts, arguments=arguments),
    st.builds(Pong, nonce=u32, server_time=floats),
    st.builds(
        Plan,
        tick=u32,
        id=u32,
        reason=st.sampled_from(Reason),
        behaviour=st.sampled_from(["go_to", "wander", "patrol", "guide", "idle"]),
        goal=st.none() | places,
        path=st.lists(st.tuples(floats, floats, floats, floats), max_size=4),
        people=st.lists(st.lists(circles, max_size=3), max_size=3),
        since_s=floats,
        blocker=st.none() | blockers,
        outcome=st.none() | st.sampled_from(Outcome),
        in_the_way=st.none() | blockers,
        tour=st.none() | tours,
    ),
    st.builds(Census, people=u32, actors=u32),
    st.builds(Doors, doors=doors),
    st.builds(StepBlock, tick=u32, block=st.binary(max_size=500)),
    st.builds(Point, id=u32, target=st.none() | places),
    st.builds(Reshape, id=u32, radius=floats, leg_m=floats, stature_m=floats, look=looks),
    st.builds(Travel, zone=texts, portal=texts),
)
