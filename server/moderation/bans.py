"""Bans: who is not let in, by resume token, by name, or by address, and until when."""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from ipaddress import IPv4Network, IPv6Network, ip_network
from typing import Final, TypeVar

from esplanade.server.moderation.skeletons import skeleton

MOST_BANS: Final = 4096
"""Bans that hold at once; more are refused."""
MOST_PATTERNS: Final = 256
"""Bans of names with a `*` in them, each of which is compared with each newcomer's name."""
MOST_STARS: Final = 3
_PROVIDED_BITS: Final = 64
"""A customer has an IPv6 network of at least so many bits, so that no narrower one is banned."""

Network = IPv4Network | IPv6Network
Key = TypeVar("Key")


@dataclass(frozen=True, slots=True)
class Ban:
    """One ban. It holds for whoever any one of the digests, the name or the address is of."""

    id: int
    text: str
    """The reason, for the person to read."""
    until_us: int | None
    """Microseconds since 1970; None for no end."""
    at_us: int
    by: str | None
    """The account that has made it."""
    digests: tuple[str, ...] = field(default=(), repr=False)
    """SHA-256 of resume tokens, hexadecimal."""
    name_pattern: str | None = None
    """A name, or with `*` for any characters; names that look alike are the same."""
    address: str | None = None
    """An address or a network."""
    lifted: bool = False

    def holds(self, now_us: int) -> bool:
        """Whether it keeps anybody out now."""
        return not self.lifted and (self.until_us is None or now_us < self.until_us)


def network(text: str) -> Network:
    """The network that an address or a range in CIDR names, of IPv6 at least 64 bits.

    Raises
    ------
    ValueError
        The text names none.
    """
    found = ip_network(text.strip(), strict=False)
    if isinstance(found, IPv4Network):
        return found
    mapped = found.network_address.ipv4_mapped
    if mapped is not None and found.prefixlen >= 96:
        return IPv4Network((mapped, found.prefixlen - 96), strict=False)
    return found if found.prefixlen <= _PROVIDED_BITS else found.supernet(new_prefix=_PROVIDED_BITS)


def check_pattern(pattern: str) -> None:
    """Check that a pattern of names is of use.

    Raises
    ------
    ValueError
        It names everybody, or has too many stars.
    """
    if pattern.count("*") > MOST_STARS:
        raise ValueError(f"a pattern has at most {MOST_STARS} *")
    if not pattern.replace("*", "").strip():
        raise ValueError("a pattern of * alone would keep everybody out")


class Bans:
    """All bans, and the search for those that keep a newcomer out."""

    def __init__(self) -> None:
        self._bans: dict[int, Ban] = {}
        self._by_digest: dict[str, set[int]] = defaultdict(set)
        self._by_name: dict[str, set[int]] = defaultdict(set)
        self._patterns: dict[int, re.Pattern[str]] = {}
        self._by_network: dict[Network, set[int]] = defaultdict(set)
        self._prefixes: dict[int, dict[int, int]] = {4: {}, 6: {}}
        """How many banned networks there are of each length, by the version of IP."""

    def __iter__(self) -> Iterator[Ban]:
        return iter(self._bans.values())

    def get(self, ban: int) -> Ban | None:
        return self._bans.get(ban)

    @property
    def holding(self) -> int:
        """Number of bans that have not been lifted; of some the time may be over."""
        return sum(not ban.lifted for ban in self._bans.values())

    @property
    def patterns(self) -> int:
        """Number of bans that are compared with each newcomer's name."""
        return len(self._patterns)

    def put(self, ban: Ban) -> None:
        """Add a ban, or put it in the place of the one with the same id."""
        self.drop(ban.id)
        self._bans[ban.id] = ban
        if not ban.lifted:
            self._index(ban)

    def lift(self, ban: int, *, lifted: bool = True) -> None:
        """Let a ban hold no more, or again."""
        found = self._bans.get(ban)
        if found is not None:
            self.put(replace(found, lifted=lifted))

    def drop(self, ban: int) -> None:
        """Forget a ban."""
        found = self._bans.pop(ban, None)
        if found is None or found.lifted:
            return
        for digest in found.digests:
            _take(self._by_digest, digest, ban)
        if found.name_pattern is not None:
            self._patterns.pop(ban, None)
            _take(self._by_name, skeleton(found.name_pattern), ban)
        if found.address is not None:
            banned = network(found.address)
            _take(self._by_network, banned, ban)
            counts = self._prefixes[banned.version]
            counts[banned.prefixlen] -= 1
            if not counts[banned.prefixlen]:
                del counts[banned.prefixlen]

    def against(self, name: str, address: str, digest: str | None, now_us: int) -> Ban | None:
        """The ban that keeps a newcomer out for longest; None if they may come in.

        `address` is a key of `esplanade.server.net.addresses`: an address, or a network of IPv6.
        """
        found = [
            ban
            for ban in (self._bans[each] for each in self._matching(name, address, digest))
            if ban.holds(now_us)
        ]
        return max(found, key=lambda ban: (ban.until_us is None, ban.until_us or 0), default=None)

    def _matching(self, name: str, address: str, digest: str | None) -> Iterable[int]:
        if not self._bans:
            return
        if digest is not None:
            yield from self._by_digest.get(digest, ())
        looks = skeleton(name)
        yield from self._by_name.get(looks, ())
        for ban, pattern in self._patterns.items():
            if pattern.fullmatch(looks):
                yield ban
        if not any(self._prefixes.values()):
            return
        try:
            came_from = network(address)
        except ValueError:
            return
        for length in self._prefixes[came_from.version]:
            if length <= came_from.prefixlen:
                wider = came_from.supernet(new_prefix=length)
                yield from self._by_network.get(wider, ())

    def _index(self, ban: Ban) -> None:
        for digest in ban.digests:
            self._by_digest[digest].add(ban.id)
        if ban.name_pattern is not None and "*" in ban.name_pattern:
            parts = [skeleton(part) if part else "" for part in ban.name_pattern.split("*")]
            self._patterns[ban.id] = re.compile(".*".join(map(re.escape, parts)), re.DOTALL)
        elif ban.name_pattern is not None:
            self._by_name[skeleton(ban.name_pattern)].add(ban.id)
        if ban.address is not None:
            banned = network(ban.address)
            self._by_network[banned].add(ban.id)
            counts = self._prefixes[banned.version]
            counts[banned.prefixlen] = counts.get(banned.prefixlen, 0) + 1


def _take(index: dict[Key, set[int]], key: Key, ban: int) -> None:
    """Take a ban out of an index, and the key with its last one."""
    found = index.get(key)
    if found is None:
        return
    found.discard(ban)
    if not found:
        del index[key]
