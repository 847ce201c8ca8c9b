"""The exit codes of all commands."""

from typing import Final

OK: Final = 0
FAILED: Final = 1
"""The command did its work, and the result is bad; or something outside stood in its way."""
USAGE: Final = 2
"""The command line, a variable of the environment or a file cannot be used."""
THRESHOLD: Final = 3
"""The command did its work, and the result is beyond a limit that the user has set."""
INTERRUPTED: Final = 130
"""Ctrl-C, as shells count it: 128 and the number of SIGINT."""
