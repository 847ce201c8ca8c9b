"""The command `esplanade`, and `python -m esplanade`: Ctrl-C ends it quietly from here on."""

import sys


def main() -> int:
    """Run the command line of this process; returns the exit code."""
    try:
        from esplanade.commandline import interrupts  # noqa: PLC0415 (Ctrl-C may come meanwhile)

        interrupts.end_quietly()
        from esplanade import cli  # noqa: PLC0415

        return cli.main(sys.argv[1:])
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    raise SystemExit(main())
