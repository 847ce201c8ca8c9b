"""`python -m esplanade`: the command without its script."""

from esplanade.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
