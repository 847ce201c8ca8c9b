import pytest

from esplanade.server.net.addresses import TrustedProxies, address_key


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("192.0.2.7", "192.0.2.7"),
        ("127.0.0.1", "127.0.0.1"),
        ("127.0.0.2", "127.0.0.2"),
        ("::1", "::1"),
        ("::2", "::/64"),
        ("::ffff:192.0.2.7", "192.0.2.7"),
        ("::ffff:127.0.0.1", "127.0.0.1"),
        ("2001:db8:1:2:3:4:5:6", "2001:db8:1:2::/64"),
        ("2001:DB8:1:2::1", "2001:db8:1:2::/64"),
        ("2001:db8:1:3::1", "2001:db8:1:3::/64"),
        ("fe80::1%eth0", "fe80::/64"),
    ],
)
def test_an_address_has_a_key(text: str, key: str) -> None:
    assert address_key(text) == key


@pytest.mark.parametrize("text", ["", "localhost", "192.0.2", "2001:db8::/64"])
def test_no_address_has_no_key(text: str) -> None:
    with pytest.raises(ValueError, match="does not appear to be"):
        address_key(text)


@pytest.mark.parametrize(
    ("forwarded", "client"),
    [
        ([], "10.0.0.1"),
        (["203.0.113.9"], "203.0.113.9"),
        (["203.0.113.9, 10.0.0.2"], "203.0.113.9"),
        (["203.0.113.9", "10.0.0.2"], "203.0.113.9"),
        # A client wrote the first entry itself; the proxy appended the second.
        (["127.0.0.1, 203.0.113.9"], "203.0.113.9"),
        (["10.0.0.3, 203.0.113.9"], "203.0.113.9"),
        (["198.51.100.1", "203.0.113.9, 10.0.0.2"], "203.0.113.9"),
        (["203.0.113.9:4711"], "203.0.113.9"),
        (["[2001:db8::5]:4711"], "2001:db8::/64"),
        (["2001:db8::5"], "2001:db8::/64"),
        (["::ffff:203.0.113.9"], "203.0.113.9"),
        # An entry that cannot be read counts as the proxy that passed it on.
        (["unknown"], "10.0.0.1"),
        (["203.0.113.9, unknown, 10.0.0.2"], "10.0.0.2"),
        (["203.0.113.9,, 10.0.0.2"], "10.0.0.2"),
        (["10.0.0.5, 10.0.0.2"], "10.0.0.5"),
        (["203.0.113.9" + ", 10.0.0.2" * 1000], "10.0.0.2"),
    ],
)
def test_the_last_address_that_no_trusted_proxy_has_is_the_client(
    forwarded: list[str], client: str
) -> None:
    proxies = TrustedProxies("10.0.0.0/8, 2001:db8:ff::/48")
    assert proxies.trusts("10.0.0.1")
    assert proxies.client_key("10.0.0.1", forwarded) == client


def test_only_trusted_proxies_are_believed() -> None:
    proxies = TrustedProxies(" 10.0.0.0/8 ,::1,")
    assert [proxies.trusts(each) for each in ("10.9.9.9", "::1", "::ffff:10.0.0.1")] == [True] * 3
    assert not any(proxies.trusts(each) for each in ("11.0.0.1", "127.0.0.1", "::2"))
    assert proxies.client_key("11.0.0.1", ["203.0.113.9"]) == "11.0.0.1"
    assert not TrustedProxies("").trusts("127.0.0.1")


def test_what_is_no_network_is_refused_by_name() -> None:
    with pytest.raises(ValueError, match=r"trusted_proxies: '10\.0\.0\.0/99' is no address"):
        TrustedProxies("10.0.0.1, 10.0.0.0/99")
