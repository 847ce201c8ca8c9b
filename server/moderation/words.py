"""A filter of whole words in chat, which are found by their skeletons."""

import re
from collections.abc import Iterable
from typing import Final, Literal

from esplanade.server.moderation.skeletons import skeleton

MASK: Final = "•••"
Action = Literal["mask", "refuse"]
_WORD: Final = re.compile(r"\w+")


class WordFilter:
    """Words that are not said here; a line with one of them is refused, or the word is masked."""

    def __init__(self, words: Iterable[str] = (), action: Action = "mask") -> None:
        self.words = tuple(dict.fromkeys(words))
        self.action: Action = action
        self._skeletons = {skeleton(word) for word in self.words}

    def masked(self, text: str) -> str:
        """The text with a mask in the place of each word that is not said here."""
        if not self._skeletons:
            return text
        return _WORD.sub(lambda found: self._seen(found[0]), text)

    def _seen(self, word: str) -> str:
        return MASK if skeleton(word) in self._skeletons else word
