"""The rules that a line of chat must keep before anybody hears it."""

import math
from collections import OrderedDict
from collections.abc import Sequence
from typing import Final

from esplanade.protocol import ErrorCode, ProtocolError
from esplanade.server.moderation.areas import Place
from esplanade.server.moderation.state import ModerationState

MOST_SPEAKERS: Final = 4096
"""Of more people in slow mode, the one who spoke longest ago is forgotten."""


class ChatGate:
    """Holds speakers to the rules of chat that operators have set."""

    def __init__(self, kept: ModerationState, storeys: Sequence[float]) -> None:
        self._kept = kept
        self._storeys = storeys
        self._spoke_s: OrderedDict[int, float] = OrderedDict()

    def pass_words(self, speaker: int, text: str, now_s: float) -> str:
        """The line as others may read it; `speaker` is any number of the one who says it.

        Raises
        ------
        ProtocolError
            It comes too soon, or has a word in it that is not said here.
        """
        rules = self._kept.rules
        seen = rules.words.masked(text)
        if seen != text and rules.words.action == "refuse":
            said = "there is a word in your line that is not said here; nobody heard it"
            raise ProtocolError(ErrorCode.WORD_REFUSED, said, None)
        if rules.every_s > 0.0:
            self._wait(speaker, rules.every_s, now_s)
        return seen

    def check_place(self, place: Place) -> None:
        """Check that a line may be said at a place.

        Raises
        ------
        ProtocolError
            It is quiet there.
        """
        if not self._kept.rules.quiet:
            return
        zone = self._kept.rules.quiet_at(place, self._storeys)
        if zone is not None:
            text = f"it is quiet here, in {zone}; nobody heard your line"
            raise ProtocolError(ErrorCode.QUIET_ZONE, text, None, {"name": zone})

    def _wait(self, speaker: int, every_s: float, now_s: float) -> None:
        rest_s = every_s - (now_s - self._spoke_s.get(speaker, -math.inf))
        if rest_s > 0.0:
            text = (
                f"people here say one line in {every_s:g} s; you may say the next in {rest_s:.0f} s"
            )
            arguments = {"seconds": round(rest_s, 1), "every_s": every_s}
            raise ProtocolError(ErrorCode.SLOW_MODE, text, None, arguments)
        self._spoke_s[speaker] = now_s
        self._spoke_s.move_to_end(speaker)
        if len(self._spoke_s) > MOST_SPEAKERS:
            self._spoke_s.popitem(last=False)
