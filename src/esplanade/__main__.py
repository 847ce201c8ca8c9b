"""The command `esplanade`, and `python -m esplanade`: Ctrl-C ends it quietly from here on."""

import os
import sys


def main() -> int:
    """Run the command line of this process; returns the exit code."""
    try:
        from esplanade.commandline import exit_codes, interrupts  # noqa: PLC0415 (Ctrl-C may come)

        interrupts.end_quietly()
        from esplanade import cli  # noqa: PLC0415

        code = cli.main(sys.argv[1:])
        if code == exit_codes.INTERRUPTED:
            interrupts.end()
    except KeyboardInterrupt:
        os._exit(130)
    return code


if __name__ == "__main__":
    raise SystemExit(main())
