"""Text of people on a terminal, which it must not steer."""


def on_one_line(text: str) -> str:
    """The text, with a mark in place of whatever is not printable, such as an end of line."""
    return "".join(each if each.isprintable() else "\N{REPLACEMENT CHARACTER}" for each in text)
