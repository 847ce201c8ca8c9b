"""The rules that all actors of a zone keep to, as numbers with units, ranges and effects.

What two actors may well differ in, their bodies and tempers, are parameters of each
(`ActorParameters`). The numbers here hold for everyone, since two who meet have to keep to the same
rules, and they stay as they are while a world runs.
"""

from __future__ import annotations

from functools import cached_property
from typing import Annotated, Any, Final, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

Group = Literal[
    "clearances",
    "crowding",
    "jams",
    "narrow places",
    "lanes",
    "lost time",
    "search",
    "perturbation",
    "steps",
    "reasons",
]
"""A heading under which rules are listed together."""


def _rule(group: Group, unit: str, least: float, most: float, description: str) -> object:
    return Field(
        ge=least,
        le=most,
        allow_inf_nan=False,
        description=description,
        json_schema_extra={"unit": unit, "group": group},
    )


def _switch(group: Group, description: str) -> object:
    return Field(description=description, json_schema_extra={"unit": "yes or no", "group": group})


class RuleModel(BaseModel):
    """The numbers of the rules by which actors plan among people and among each other.

    A rule is switched off by its switch, by a weight of 0, or by a number of actors that never come
    together; `python -m benchmarks.ablations` shows what each is for.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    reserves: Annotated[
        bool,
        _switch(
            "clearances",
            "Whether paths keep clear of those that other actors have planned. Without, actors "
            "still do not touch: each step is checked.",
        ),
    ] = True

    margin_m: Annotated[
        float,
        _rule(
            "clearances",
            "m",
            0.0,
            0.5,
            "Planned paths of two actors stay apart by this much more than the sum of the radii.",
        ),
    ] = 0.03
    yielding_weight: Annotated[
        float,
        _rule(
            "clearances",
            "1",
            0.0,
            10.0,
            "A meeting with an actor that will yield weighs this many certain contacts with a "
            "person. If it were as dear as one, everyone would rather wait than go where others "
            "stand, and nobody would make way.",
        ),
    ] = 0.25
    evading_slices: Annotated[
        int,
        _rule(
            "clearances",
            "slices",
            0,
            18,
            "In so many first slices of a path an actor may have no time left to get out of "
            "another's way, so that a meeting is allowed that leaves more room than standing.",
        ),
    ] = 2
    evading_m: Annotated[
        float,
        _rule(
            "clearances",
            "m",
            0.0,
            0.5,
            "By so much more room than standing a move has to leave to be such an evasion.",
        ),
    ] = 0.005
    wall_room_m: Annotated[
        float,
        _rule(
            "clearances",
            "m",
            0.01,
            1.0,
            "A wall nearer to the body than this has a cost, that of `wall_weight`.",
        ),
    ] = 0.15

    meeting_room_m: Annotated[
        float,
        _rule(
            "crowding",
            "m",
            0.0,
            3.0,
            "Room that two actors with opposite courses would like if one of them is held up.",
        ),
    ] = 0.8
    meeting_weight: Annotated[
        float,
        _rule(
            "crowding",
            "1",
            0.0,
            10.0,
            "Weight of having none of `meeting_room_m`, in certain contacts with a person. Half of "
            "it counts when the two face each other, more with the other on the right, nothing "
            "with the other on the left. So both keep to the right, and two streams form where "
            "there was a crowd.",
        ),
    ] = 0.2
    queue_room_m: Annotated[
        float,
        _rule(
            "crowding",
            "m",
            0.0,
            3.0,
            "Room that two actors who are both held up would like. Coming closer gains a little "
            "once, but costs as long as both stay: those that wait leave gaps, through which "
            "others come out.",
        ),
    ] = 0.5
    queue_weight: Annotated[
        float,
        _rule(
            "crowding",
            "1",
            0.0,
            10.0,
            "Weight of having none of `queue_room_m`, in certain contacts with a person.",
        ),
    ] = 0.2
    against_cosine: Annotated[
        float,
        _rule(
            "crowding",
            "1",
            0.0,
            1.0,
            "Courses are against each other if the cosine between them is below minus this.",
        ),
    ] = 0.2
    held_up_part: Annotated[
        float,
        _rule(
            "crowding",
            "1",
            0.0,
            1.0,
            "An actor that is slower than this part of its preferred speed is held up.",
        ),
    ] = 0.3

    settled_m: Annotated[
        float,
        _rule(
            "jams",
            "m",
            0.0,
            10.0,
            "Actors within this distance of their goal get the lowest priority.",
        ),
    ] = 1.0
    jam_m: Annotated[
        float,
        _rule(
            "jams",
            "m",
            0.5,
            50.0,
            "Actors that are held up within this distance belong to the same jam.",
        ),
    ] = 8.0
    jam_actors: Annotated[
        int,
        _rule(
            "jams",
            "actors",
            1,
            1_000_000,
            "So many actors that are held up make a jam for one that goes against them.",
        ),
    ] = 8

    orders_passages: Annotated[
        bool,
        _switch(
            "narrow places",
            "Whether actors at a contested passage go in the order of who leaves and enters it.",
        ),
    ] = True
    narrow_m: Annotated[
        float,
        _rule(
            "narrow places",
            "m",
            0.2,
            10.0,
            "Greatest width of a passage, between sides that leave less than `wall_part` of the "
            "radius.",
        ),
    ] = 2.2
    ahead_m: Annotated[
        float,
        _rule(
            "narrow places",
            "m",
            1.0,
            100.0,
            "Distance ahead along the route within which passages are looked for; there the cost "
            "of being left of a lane begins.",
        ),
    ] = 20.0
    straight_part: Annotated[
        float,
        _rule(
            "narrow places",
            "1",
            0.0,
            1.0,
            "Least part of the way to a passage that the straight line to it has to be: a passage "
            "around a corner leads nobody to one side of it yet.",
        ),
    ] = 0.9
    wall_part: Annotated[
        float,
        _rule(
            "narrow places",
            "1",
            0.1,
            1.0,
            "Places with a clearance below this part of the radius are the sides of a passage.",
        ),
    ] = 0.8
    deep_m: Annotated[
        float,
        _rule(
            "narrow places",
            "m",
            0.0,
            10.0,
            "The narrowest place within this distance of a passage's entrance is its middle.",
        ),
    ] = 1.0
    rays: Annotated[
        int,
        _rule(
            "narrow places",
            "lines",
            2,
            64,
            "Lines along which the width of a passage is measured before the best is refined.",
        ),
    ] = 8
    look_s: Annotated[
        float,
        _rule(
            "narrow places",
            "s",
            0.0,
            10.0,
            "Least time between two looks for passages. It is up to twice as long, depending on "
            "the rank, so that actors do not all look in the same tick.",
        ),
    ] = 1.0
    same_passage_m: Annotated[
        float,
        _rule(
            "narrow places",
            "m",
            0.0,
            10.0,
            "Two passages may be the two ends of one if they are no further apart than this, both "
            "across the direction through them and in height.",
        ),
    ] = 1.0
    long_passage_m: Annotated[
        float,
        _rule(
            "narrow places",
            "m",
            0.0,
            50.0,
            "Greatest distance between the two ends of one passage, in the direction through it.",
        ),
    ] = 6.0
    contested_actors: Annotated[
        int,
        _rule(
            "narrow places",
            "actors",
            1,
            1_000_000,
            "So many actors that want to go through a passage against an actor make it contested.",
        ),
    ] = 8
    passed_m: Annotated[
        float,
        _rule(
            "narrow places",
            "m",
            0.0,
            50.0,
            "Distance behind a passage up to which actors that have come through have priority "
            "over those that still have to come there.",
        ),
    ] = 8.0
    progress_m: Annotated[
        float,
        _rule(
            "narrow places",
            "m",
            0.0,
            10.0,
            "An actor makes progress when it comes nearer to a passage by this distance.",
        ),
    ] = 0.5
    waiting_mps: Annotated[
        float,
        _rule(
            "narrow places",
            "m/s",
            0.0,
            10.0,
            "A second without progress counts like this distance to a passage; with 0 those that "
            "were crowded out to the side stay there until all others are through.",
        ),
    ] = 0.2

    lane_shift_m: Annotated[
        float,
        _rule(
            "lanes",
            "m",
            0.0,
            5.0,
            "Greatest distance from the middle of a passage to the left border of a lane; in a "
            "narrow passage the border is half-way between the middle and the side.",
        ),
    ] = 0.2
    lane_after_m: Annotated[
        float,
        _rule(
            "lanes",
            "m",
            0.0,
            50.0,
            "Distance behind a passage up to which actors that have come through keep right.",
        ),
    ] = 4.0
    left_rad: Annotated[
        float,
        _rule(
            "lanes",
            "rad",
            0.05,
            1.57,
            "An actor is wholly on the left of a lane if it is seen at this angle from its "
            "beginning.",
        ),
    ] = 1.0

    most_behind_s: Annotated[
        float, _rule("lost time", "s", 0.0, 600.0, "More lost time than this is not made up.")
    ] = 5.0
    ease_s: Annotated[
        float,
        _rule(
            "lost time",
            "s",
            0.01,
            60.0,
            "An actor that is behind by less than this makes it up more slowly.",
        ),
    ] = 0.5

    greedy: Annotated[
        bool,
        _switch(
            "search",
            "Whether actors search by the printed key of fig. 5, which forgets the risk already "
            "taken.",
        ),
    ] = False
    weighs_paths: Annotated[
        bool,
        _switch(
            "search",
            "Whether a path that was found replaces the followed one only if it costs less; "
            "otherwise it always does.",
        ),
    ] = True
    depth_bonus_s: Annotated[
        float,
        _rule(
            "search",
            "s",
            0.0,
            1.0,
            "Least bonus of a node for each step of its depth: the path may cost this much more a "
            "step than the best, and the search looks at a fraction of the nodes.",
        ),
    ] = 0.01
    goes_on: Annotated[
        bool,
        _switch(
            "search",
            "Whether a search goes on from the followed path, as far as that is legal, once "
            "somebody has got in its way, and expects what that path costs.",
        ),
    ] = True
    checked_slices: Annotated[
        int,
        _rule(
            "search",
            "slices",
            0,
            18,
            "So many first slices of the path of an actor that is not due are checked against "
            "walls and reservations; if they have become illegal, it is planned all the same.",
        ),
    ] = 6
    fine_steps: Annotated[
        int,
        _rule(
            "search",
            "steps",
            0,
            1000,
            "Nodes after so many steps branch into fewer moves: what is far ahead will be decided "
            "anew.",
        ),
    ] = 4
    likely_part: Annotated[
        float,
        _rule(
            "search",
            "1",
            0.0,
            1.0,
            "Part of the cost of the followed path beyond its time that any other path is expected "
            "to have.",
        ),
    ] = 0.7
    dodge_cells: Annotated[
        int,
        _rule(
            "search",
            "cells",
            0,
            1000,
            "An actor that others have made go to and fro on edges, so that it has used up what "
            "its body bears, or all but a cell of it, may still go on to where its way leaves "
            "them, and so many cells out of somebody's way.",
        ),
    ] = 3
    narrow_part: Annotated[
        float,
        _rule(
            "search",
            "1",
            0.0,
            1.0,
            "A path that makes less than this part of the progress that is possible in its time "
            "leads nowhere; ways over anchors, through passages hardly wider than the body, are "
            "weighed against it.",
        ),
    ] = 0.25
    narrow_over_s: Annotated[
        float,
        _rule(
            "search",
            "s",
            0.0,
            10.0,
            "For an actor that stands, a way over anchors may cost so much more than its path, "
            "which may lead where it cannot follow, or put off the start from tick to tick.",
        ),
    ] = 0.6
    narrow_held_s: Annotated[
        float,
        _rule(
            "search",
            "s",
            0.0,
            1000.0,
            "An actor that has come no nearer to its goal for so long, with nobody near, may have "
            "slid into a gap that is just too narrow: it goes over anchors, by lines that "
            "barriers leave exactly free.",
        ),
    ] = 1.0
    narrow_alone_m: Annotated[
        float,
        _rule(
            "search",
            "m",
            0.0,
            1000.0,
            "With another actor nearer than this, it may be held up by that one instead.",
        ),
    ] = 3.0
    narrow_pace: Annotated[
        float,
        _rule(
            "search",
            "1",
            0.05,
            1.0,
            "A way over anchors is walked at this part of the preferred speed.",
        ),
    ] = 0.5

    perturbs: Annotated[
        bool, _switch("perturbation", "Whether followed paths are bent away from risk, figs. 7-9.")
    ] = True
    shortest_stretch: Annotated[
        int,
        _rule(
            "perturbation",
            "slices",
            2,
            1000,
            "Stretches of fewer slices are not split further.",
        ),
    ] = 4
    offsets: Annotated[
        int, _rule("perturbation", "1", 0, 64, "Candidates m' on either side of the middle.")
    ] = 3
    offset_m: Annotated[
        float, _rule("perturbation", "m", 0.01, 5.0, "Distance between candidates.")
    ] = 0.2
    least_risk: Annotated[
        float,
        _rule(
            "perturbation",
            "1",
            0.0,
            1.0,
            "A bend has to lower the mean risk of a stretch by so much.",
        ),
    ] = 1e-3

    checks_steps: Annotated[
        bool, _switch("steps", "Whether the next step is checked once more against people.")
    ] = True
    minds_turns: Annotated[
        bool,
        _switch(
            "steps",
            "Whether the last check takes people to go on at their newest velocity too, not only "
            "as predicted.",
        ),
    ] = True
    sidesteps: Annotated[
        bool,
        _switch(
            "steps",
            "Whether an actor whose step would touch another one tries half of it and sidesteps "
            "before it stands.",
        ),
    ] = True
    step_margin_m: Annotated[
        float,
        _rule("steps", "m", 0.0, 0.5, "No step brings the bodies of two actors closer than this."),
    ] = 0.01
    heading_mps: Annotated[
        float, _rule("steps", "m/s", 0.0, 5.0, "An actor that is slower keeps its heading.")
    ] = 0.1
    look_ahead_s: Annotated[
        float,
        _rule(
            "steps",
            "s",
            0.05,
            5.0,
            "The last check before a step looks this far ahead, in two halves, but no further than "
            "until the actor stands at its goal.",
        ),
    ] = 1.0
    people_near_m: Annotated[
        float,
        _rule("steps", "m", 0.5, 50.0, "People further away than this cannot be met in that time."),
    ] = 4.0
    sway_m: Annotated[
        float,
        _rule(
            "steps",
            "m",
            0.0,
            1.0,
            "A person's body sways by this much beyond its radius: in the last check it counts as "
            "touched that near.",
        ),
    ] = 0.05

    stands_mps: Annotated[
        float, _rule("reasons", "m/s", 0.0, 1.0, "An actor that is slower than this stands.")
    ] = 0.05
    walks_mps: Annotated[
        float,
        _rule("reasons", "m/s", 0.0, 3.0, "An actor that is faster than this does not wait."),
    ] = 0.3
    somebody_m: Annotated[
        float,
        _rule(
            "reasons",
            "m",
            0.0,
            50.0,
            "Way is given only to bodies that are no further away than this.",
        ),
    ] = 2.5

    @cached_property
    def row(self) -> NDArray[np.void]:
        """The one record (1,) of `RULES` that kernels look them up in."""
        values = tuple(getattr(self, name) for name in RULES.names or ())
        return np.array([values], dtype=RULES)


_TYPES: Final[dict[Any, str]] = {bool: "?", int: "i8", float: "f8"}
RULES: Final = np.dtype(
    [(name, _TYPES[field.annotation]) for name, field in RuleModel.model_fields.items()]
)
"""The rules as kernels know them, one field each, in the units of their names."""
