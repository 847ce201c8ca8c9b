"""Tells people that their walk leads elsewhere, since nobody can stand where they wanted to go."""

from typing import Final

from esplanade.planning import MovedEnd, MoveReason
from esplanade.protocol import ErrorCode, ProtocolError
from esplanade.protocol.codes import NoticeCode
from esplanade.protocol.messages import Notice, WalkTo

_TEXTS: Final = {
    MoveReason.INSIDE_WALL: "That place is inside a wall or something solid",
    MoveReason.NEAR_WALL: "That place is too near a wall or an edge",
    MoveReason.NO_GROUND: "There is no floor at that place",
    MoveReason.OTHER_REGION: "No way leads to that place",
}


def notice_of(wish: WalkTo, moved: MovedEnd) -> Notice:
    """The notice that a walk leads to another place than was wished for."""
    text = f"{_TEXTS[moved.reason]}; you walk to the nearest one, {moved.distance_m:.1f} m from it."
    return Notice(text=text, notice=NoticeCode.GOAL_MOVED, arguments=_arguments(wish, moved))


def refusal_of(wish: WalkTo, moved: MovedEnd) -> ProtocolError:
    """The refusal of a walk that was to lead to the very place, or nowhere."""
    text = f"{_TEXTS[moved.reason].lower()}; the nearest one is {moved.distance_m:.1f} m from it"
    return ProtocolError(ErrorCode.GOAL_MOVED, text, None, _arguments(wish, moved))


def _arguments(wish: WalkTo, moved: MovedEnd) -> dict[str, str | float]:
    x, y, z = (round(value, 3) for value in moved.place)
    why = moved.reason.name.lower()
    return {
        "seq": wish.seq,
        "moved": round(moved.distance_m, 3),
        "why": why,
        "x": x,
        "y": y,
        "z": z,
    }
