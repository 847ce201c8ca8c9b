"""Bodies as the command line names them."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final

from esplanade.commandline.errors import UsageError
from esplanade.planning.scene.bodies import Body
from esplanade.scenery.values import BodyWish

PRESETS: Final[Mapping[str, Callable[[], Body]]] = {"adult": Body.adult, "child": Body.child}


def made_body(wish: BodyWish) -> Body:
    """The body that was asked for.

    Raises
    ------
    UsageError
        There is no body of these measures.
    """
    try:
        return replace(PRESETS[wish.preset](), **wish.changes)  # type: ignore[arg-type]
    except ValueError as error:
        raise UsageError(f"--body: {error}") from None
