from pathlib import Path

import pytest
from pydantic import ValidationError

from esplanade.server.settings import ServerSettings


def test_every_field_says_what_it_is_and_where_it_belongs() -> None:
    for name, field in ServerSettings.model_fields.items():
        assert field.description, name
        assert isinstance(field.json_schema_extra, dict), name
        assert field.json_schema_extra["group"], name


def test_defaults_are_these() -> None:
    settings = ServerSettings()
    assert (settings.port, settings.private_port, settings.private_host) == (
        8080,
        8081,
        "127.0.0.1",
    )
    assert (settings.tick_rate, settings.tick_s, settings.actors, settings.seed) == (
        20,
        0.05,
        10,
        0,
    )
    assert (settings.person_max_speed_mps, settings.resume_seconds) == (3.0, 30.0)
    assert (settings.slow_bytes, settings.drop_bytes, settings.drop_seconds) == (
        32_768,
        262_144,
        5.0,
    )
    assert settings.origins is None


def test_the_environment_is_read_and_arguments_win(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ESPLANADE_TICK_RATE", "30")
    monkeypatch.setenv("ESPLANADE_SEED", "7")
    settings = ServerSettings(seed=8)
    assert (settings.tick_rate, settings.seed) == (30, 8)


def test_settings_are_frozen() -> None:
    settings = ServerSettings()
    with pytest.raises(ValidationError, match="frozen"):
        settings.port = 1  # type: ignore[misc]


@pytest.mark.parametrize(
    ("values", "fault"),
    [
        ({"scene": Path("a"), "crowd": Path("b")}, "one of them"),
        ({"walls": Path("a")}, "belong to a crowd"),
        ({"drop_bytes": 2048, "slow_bytes": 4096}, "greater than slow_bytes"),
        ({"trusted_proxies": "10.0.0.0/8, nginx"}, "'nginx' is no address or network"),
        ({"tls_cert": Path("a")}, "give both of them, or none"),
        ({"tls_key": Path("a")}, "give both of them, or none"),
        ({"root_path": "world"}, "'world' is no path such as /world"),
        ({"world_password": "x"}, "they belong to a world that is --closed"),
        ({"closed": True, "identity_header": "X-User"}, "say by --trusted-proxies"),
        (
            {"closed": True, "identity_header": "X User", "trusted_proxies": "::1"},
            "is no name of a header",
        ),
        ({"public_url": "world.example.org"}, "is no address such as https://"),
        ({"root_path": "/a/../b"}, "is no path such as"),
        ({"root_path": "/a b"}, "is no path such as"),
        ({"port": -1}, "greater than or equal to 0"),
        ({"colour": "red"}, "not permitted"),
    ],
)
def test_what_does_not_fit_together_is_refused(values: dict[str, object], fault: str) -> None:
    with pytest.raises(ValidationError, match=fault):
        ServerSettings(**values)  # type: ignore[arg-type]


def test_origins_are_a_list() -> None:
    settings = ServerSettings(allowed_origins="https://a.example, https://b.example")
    assert settings.origins == ["https://a.example", "https://b.example"]
