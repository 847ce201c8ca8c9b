"""The subjects of a world on a message broker."""

import re
from typing import Final

_NAME: Final = re.compile(r"[a-z0-9-]{1,40}")


class Subjects:
    """Names what hosts and gateways of one world say to each other.

    Raises
    ------
    ValueError
        A name is not made of 1 to 40 lower-case letters, digits and hyphens.
    """

    def __init__(self, world: str) -> None:
        self._root = f"e.{_checked('world', world)}"

    def frames(self, zone: str) -> str:
        """The frames of a zone, from its host to all gateways with viewers there."""
        return f"{self._root}.z.{_checked('zone', zone)}.f"

    def questions(self, zone: str) -> str:
        """Questions to the host of a zone, each with the subject on which it is answered."""
        return f"{self._root}.z.{_checked('zone', zone)}.ask"

    def inputs(self, zone: str) -> str:
        """The batches of inputs of people, from all gateways to the host of a zone."""
        return f"{self._root}.z.{_checked('zone', zone)}.in"

    def gateway(self, name: str) -> str:
        """The answers for people of one gateway, from the hosts of all zones."""
        return f"{self._root}.g.{_checked('gateway', name)}"

    def calls(self, zone: str, epoch: int) -> str:
        """Requests of operators, from any gateway to the host that owns a zone since an epoch.

        With `.` and its name behind, it has what belongs to one request after its begin.
        """
        return f"{self._root}.z.{_checked('zone', zone)}.op.{epoch}"

    def called(self, gateway: str) -> str:
        """The answers to requests of operators who are at a gateway, `.` and the name of one
        behind."""
        return f"{self._root}.g.{_checked('gateway', gateway)}.op"

    @property
    def control(self) -> str:
        """Hints that something has changed in the database, from any process to all."""
        return f"{self._root}.ctl"


def _checked(kind: str, name: str) -> str:
    if _NAME.fullmatch(name) is None:
        raise ValueError(
            f"the name of a {kind} has 1 to 40 lower-case letters, digits and hyphens: {name!r}"
        )
    return name
