"""Waves: many actors that are alike, who come in together and may go together."""

from collections.abc import Sequence

from esplanade.protocol.commands import AddActors, CommandFault, Facts, NewActor, RemoveActors
from esplanade.server.console.presets import PRESET
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.state import OperatedState
from esplanade.server.world.routes import Point


def of_wave(command: AddActors, state: OperatedState, pending: Facts) -> Sequence[NewActor]:
    """The actors that a command adds, each as it is described.

    Raises
    ------
    RefusedError
        There is no such preset or place.
    """
    if command.count is None:
        return command.actors
    values: dict[str, float] = {}
    if command.preset is not None:
        saved = pending.get(f"preset:{command.preset}", {}).get(PRESET)
        try:
            found = saved["values"] if saved else state.presets.found(command.preset).values
        except RefusedError as error:
            raise error.within("preset") from None
        values.update(found)
    values.update(command.overrides)
    one = NewActor.model_construct(
        id=None,
        name=None,
        behaviour=command.behaviour,
        tags=command.tags,
        overrides=values,
        place=where(command, state),
    )
    return [one] * command.count


def where(command: AddActors, state: OperatedState) -> Point | None:
    """The point around which a wave comes in; None for anywhere.

    Raises
    ------
    RefusedError
        The scene has no such place.
    """
    near = command.near
    if not isinstance(near, str):
        return near
    for place in state.zone.scene.places:
        if place.name == near:
            return (*place.position, place.z_m)
    text = f"the scene has no place {near!r}"
    raise RefusedError.of("unknown_place", text, "near", place=near)


def leaving(command: RemoveActors, state: OperatedState) -> tuple[str, ...]:
    """The actors that a command takes out of the world.

    Raises
    ------
    RefusedError
        Nobody has the tag.
    """
    if command.tag is None:
        return command.actors
    found = tuple(spec.id for spec in state.zone.actors.values() if command.tag in spec.tags)
    if not found:
        fault = CommandFault(
            code="unknown_tag",
            text=f"no actor has the tag {command.tag}",
            path=["tag"],
            arguments={"tag": command.tag},
        )
        raise RefusedError([fault])
    return found
