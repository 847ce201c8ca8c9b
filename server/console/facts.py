"""Facts one after the other."""

from collections.abc import Sequence

from esplanade.protocol.commands import Facts


def together(all_facts: Sequence[Facts]) -> Facts:
    """Facts one after the other: later ones prevail."""
    found: Facts = {}
    for facts in all_facts:
        for subject, fields in facts.items():
            found[subject] = {**found.get(subject, {}), **fields}
    return found
