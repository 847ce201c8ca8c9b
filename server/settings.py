"""Every setting of the server process, in one frozen object built at the composition root.

Values come from the command line, then from environment variables `ESPLANADE_<NAME>`, then from
the defaults here. Each field carries its group, unit and range; `esplanade.server.cli` makes
`--help` of it.
"""

from pathlib import Path
from typing import Any, Literal, Self

from pydantic import Field, JsonValue, SecretStr, model_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

ENV_PREFIX = "ESPLANADE_"

WORLD = "world"
PEOPLE = "people"
NETWORK = "network"
LIMITS = "limits on clients"
LOGS = "logs"


def _option(default: Any, group: str, description: str, unit: str = "", **limits: Any) -> Any:
    extra: dict[str, JsonValue] = {"group": group, "unit": unit}
    return Field(default, description=description, json_schema_extra=extra, **limits)


class ServerSettings(BaseSettings):
    """Settings of `esplanade serve`."""

    model_config = SettingsConfigDict(env_prefix=ENV_PREFIX, frozen=True, extra="forbid")

    scene: Path | None = _option(
        None, WORLD, "scene to run, a JSON file; without one, the gallery that comes along"
    )
    crowd: Path | None = _option(
        None, WORLD, "fit the scene to this recorded crowd (CSV t,id,x,y) instead of --scene"
    )
    walls: Path | None = _option(
        None, WORLD, "walls around the crowd; without it, NAME.walls.json beside the crowd's file"
    )
    actors: int = _option(10, WORLD, "computer-run actors that walk about", ge=0, le=500)
    seed: int = _option(0, WORLD, "seed of everything random in the world", ge=0, le=2**32 - 1)
    tick_rate: int = _option(20, WORLD, "ticks of the world", "per second", ge=5, le=60)

    person_radius_m: float = _option(0.25, PEOPLE, "radius of a person", "m", ge=0.05, le=1.0)
    person_max_speed_mps: float = _option(
        3.0, PEOPLE, "fastest a person may move; a crowd raises it to what it needs", "m/s",
        gt=0.0, le=100.0,
    )  # fmt: skip
    person_walk_speed_mps: float = _option(
        1.6, PEOPLE, "speed of a person who is sent to a point", "m/s", gt=0.0, le=100.0
    )
    view_radius_m: float = _option(
        40.0, PEOPLE, "others come into view at this distance, and leave it 15 % further off", "m",
        ge=1.0, le=1000.0,
    )  # fmt: skip
    view_limit: int = _option(
        100, PEOPLE, "most others that one person sees, the nearest first", ge=1, le=4000
    )
    steps_radius_m: float = _option(
        25.0, PEOPLE, "steps of others are sent within this distance, and 15 % further off to "
        "whom they have been sent before", "m", ge=1.0, le=1000.0,
    )  # fmt: skip
    steps_limit: int = _option(
        60, PEOPLE, "most others whose steps are sent to one person, the nearest first",
        ge=0, le=250,
    )  # fmt: skip
    resume_seconds: float = _option(
        30.0, PEOPLE, "how long a lost connection's avatar stands and waits", "s", ge=0.0, le=3600.0
    )

    host: str = _option("0.0.0.0", NETWORK, "address for people: web client and WebSocket")  # noqa: S104
    port: int = _option(8080, NETWORK, "port for people; 0 takes a free one", ge=0, le=65535)
    private_host: str = _option(
        "127.0.0.1", NETWORK, "address of /healthz, /readyz and /metrics; keep it private"
    )
    private_port: int = _option(
        8081, NETWORK, "port of /healthz, /readyz and /metrics; 0 takes a free one", ge=0, le=65535
    )
    allowed_origins: str = _option(
        "", NETWORK,
        "origins whose pages may open a WebSocket, separated by commas; empty allows every one",
    )  # fmt: skip

    max_clients: int = _option(1000, LIMITS, "most people in the world", ge=1, le=4000)
    hello_timeout_s: float = _option(
        5.0, LIMITS, "a connection must say hello within this time", "s", gt=0.0, le=60.0
    )
    message_rate: float = _option(
        60.0, LIMITS, "messages a client may send for long; twice this in a burst", "per second",
        ge=1.0, le=10_000.0,
    )  # fmt: skip
    chat_rate: float = _option(
        1.0, LIMITS, "lines a person may say for long; five in a burst", "per second",
        ge=0.01, le=100.0,
    )  # fmt: skip
    slow_bytes: int = _option(
        32 * 1024, LIMITS, "a client with more unsent than this gets no snapshots", "bytes",
        ge=1024, le=16 * 1024**2,
    )  # fmt: skip
    drop_bytes: int = _option(
        256 * 1024, LIMITS, "a client with more unsent than this is dropped", "bytes",
        ge=1024, le=64 * 1024**2,
    )  # fmt: skip
    drop_seconds: float = _option(
        5.0, LIMITS, "a client that stays slow for this time is dropped", "s", gt=0.0, le=600.0
    )

    operator_key: SecretStr = _option(
        SecretStr(""), LIMITS,
        "who says this key may open and close doors; better set in the environment than here; "
        "empty: nobody",
    )  # fmt: skip

    log_format: Literal["console", "json"] = _option("console", LOGS, "lines for people or JSON")
    log_level: Literal["debug", "info", "warning", "error"] = _option(
        "info", LOGS, "least level that is logged"
    )

    @property
    def tick_s(self) -> float:
        return 1.0 / self.tick_rate

    @property
    def origins(self) -> list[str] | None:
        """Allowed origins, None for any."""
        names = [name.strip() for name in self.allowed_origins.split(",") if name.strip()]
        return names or None

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        if self.scene and self.crowd:
            raise ValueError("scene and crowd: give one of them, not both")
        if self.walls and not self.crowd:
            raise ValueError("walls: they belong to a crowd, but none is given")
        if self.drop_bytes <= self.slow_bytes:
            raise ValueError("drop_bytes: must be greater than slow_bytes")
        return self
