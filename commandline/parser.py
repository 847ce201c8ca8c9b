"""The parser of a command: argparse, with faults in one line that say what to do."""

import difflib
from argparse import Action, ArgumentError, ArgumentParser, Namespace, RawDescriptionHelpFormatter
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NoReturn

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import UsageError


class Parser(ArgumentParser):
    """Options of a command.

    `run` names the function that does the command, as "package.module:function". It is imported
    once the options are known to be right. `check` raises `UsageError` where options do not fit
    together.
    """

    def __init__(
        self,
        prog: str,
        *,
        run: str = "",
        check: Callable[[Namespace], None] | None = None,
        **more: Any,
    ) -> None:
        more.setdefault("formatter_class", RawDescriptionHelpFormatter)
        super().__init__(prog=prog, allow_abbrev=False, **more)
        self.check = check
        if run:
            self.set_defaults(run=run, prog=prog)

    @property
    def option_names(self) -> list[str]:
        """Every option that there is, in its long form."""
        return [name for name in self._option_string_actions if name.startswith("--")]

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: Namespace | None = None
    ) -> tuple[Namespace, list[str]]:
        words = list(args or ())
        if self._subparsers is None:
            self._refuse_unknown(words)
        found, rest = super().parse_known_args(words, namespace)
        if rest:
            is_option = rest[0].startswith("-")
            self.error(f"there is no option {rest[0]}" if is_option else f"{rest[0]}: not expected")
        if self.check is not None:
            try:
                self.check(found)
            except UsageError as error:
                self.error(str(error))
        return found, rest

    def read(self, action: Action, text: str) -> Any:
        """The value that a word means for this option.

        Raises
        ------
        ArgumentError
            It means none.
        """
        value = self._get_value(action, text)
        self._check_value(action, value)
        return value

    def error(self, message: str) -> NoReturn:
        """End the command with one line."""
        told = message.removeprefix("argument ")
        stop = "" if told.endswith("?") else ";"
        self.exit(exit_codes.USAGE, f"{self.prog}: {told}{stop} see `{self.prog} --help`\n")

    def _refuse_unknown(self, words: Sequence[str]) -> None:
        for word in words:
            if word == "--":
                return
            name = word.partition("=")[0]
            if word.startswith("--") and " " not in word and name not in self.option_names:
                self.error(f"there is no option {name}{suggestion(name, self.option_names)}")

    def _check_value(self, action: Action, value: Any) -> None:
        # An argument of which there may be none is checked as an empty list.
        if action.choices is None or value == [] or value in action.choices:
            return
        choices = [str(choice) for choice in action.choices]
        near = suggestion(value, choices) if isinstance(value, str) else ""
        hint = near or f"; there are {', '.join(choices)}"
        raise ArgumentError(action, f"{str(value)!r} is no choice{hint}")


def suggestion(word: str, known: Iterable[str]) -> str:
    """The known word that is nearest, as a question; empty when none is near."""
    near = difflib.get_close_matches(word, list(known), n=1)
    return f"; did you mean {near[0]}?" if near else ""
