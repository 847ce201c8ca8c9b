"""Bans by token, name and address: what is compared, and which of several is told."""

from hypothesis import given
from hypothesis import strategies as st

from esplanade.server.moderation.bans import Ban, Bans, network

NOW_US = 1_000


def ban(number: int, **what: object) -> Ban:
    values: dict[str, object] = {"text": "", "until_us": None, "at_us": 0, "by": None}
    return Ban(number, **{**values, **what})  # type: ignore[arg-type]


def bans(*some: Ban) -> Bans:
    made = Bans()
    for one in some:
        made.put(one)
    return made


def test_the_longest_of_several_is_told_and_those_that_are_over_hold_no_more() -> None:
    made = bans(
        ban(1, name_pattern="Eve", until_us=2_000),
        ban(2, address="192.0.2.0/24", until_us=3_000),
        ban(3, digests=("ab",), until_us=999),
    )
    found = made.against("eve", "192.0.2.9", "ab", NOW_US)
    assert found is not None
    assert found.id == 2
    made.lift(2)
    found = made.against("eve", "192.0.2.9", None, NOW_US)
    assert found is not None
    assert found.id == 1
    assert made.against("eve", "192.0.2.9", None, 2_000) is None
    made.lift(2, lifted=False)
    assert made.against("Ann", "192.0.2.9", None, NOW_US) is not None
    made.drop(2)
    assert made.against("Ann", "192.0.2.9", None, NOW_US) is None


def test_names_that_look_alike_are_one_and_stars_stand_for_anything() -> None:
    made = bans(
        ban(1, name_pattern="Eve"), ban(2, name_pattern="*troll*"), ban(3, name_pattern="x.*y")
    )
    kept_out = {"Eve", "EVE", "еve", "troll", "a Troll 7", "x.y", "x. and y"}
    let_in = {"Eva", "Steve", "trol", "xy", "xay", "x.yz"}
    assert {n for n in kept_out | let_in if made.against(n, "1.2.3.4", None, 0)} == kept_out


def test_networks_of_both_kinds() -> None:
    assert str(network("::ffff:192.0.2.7")) == "192.0.2.7/32"
    assert str(network("2001:db8::7")) == "2001:db8::/64"
    made = bans(ban(1, address="2001:db8::7"), ban(2, address="10.0.0.0/8"))
    assert made.against("Ann", "2001:db8::/64", None, 0) is not None
    assert made.against("Ann", "2001:db8:0:1::/64", None, 0) is None
    assert made.against("Ann", "10.200.0.1", None, 0) is not None
    assert made.against("Ann", "::1", None, 0) is None
    assert made.against("Ann", "not an address", None, 0) is None


_addresses = st.ip_addresses(v=4).map(str)
_what = st.one_of(
    st.builds(lambda a, n: {"address": f"{a}/{n}"}, _addresses, st.integers(0, 32)),
    st.builds(lambda name: {"name_pattern": name}, st.sampled_from(["Ann", "Ben", "A*", "*n"])),
    st.builds(lambda digest: {"digests": (digest,)}, st.sampled_from(["a", "b"])),
)


@given(st.lists(_what, max_size=8), st.sets(st.integers(0, 7)), _addresses)
def test_an_index_finds_what_looking_at_each_one_finds(
    wanted: list[dict[str, object]], lifted: set[int], address: str
) -> None:
    made = bans(*(ban(k, **what) for k, what in enumerate(wanted)))
    for k in lifted:
        made.lift(k)
    for name in ("Ann", "Ben", "Zoe"):
        for digest in ("a", None):
            alone = any(
                bans(ban(0, **what)).against(name, address, digest, 0) is not None
                for k, what in enumerate(wanted)
                if k not in lifted
            )
            assert (made.against(name, address, digest, 0) is not None) is alone
