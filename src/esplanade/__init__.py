"""Esplanade: a shared place where people and computer-run actors walk among each other."""


def __getattr__(name: str) -> str:
    """The version, asked for only by whoever wants it: to look it up takes longer than to start."""
    if name != "__version__":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib.metadata import version  # noqa: PLC0415

    return version("esplanade")
