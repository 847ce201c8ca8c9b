"""Every setting of the server process, in one frozen object built at the composition root.

Values come from the command line, then from environment variables `ESPLANADE_<NAME>`, then from
the defaults. Defaults, ranges and descriptions stand in `esplanade.server.options`.
"""

from pathlib import Path
from typing import Any, Literal, Self

from pydantic import SecretStr, model_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

from esplanade.commandline import fields
from esplanade.server.options import SETTINGS, check


def _field(name: str) -> Any:
    return fields.field(SETTINGS, name)


class ServerSettings(BaseSettings):
    """Settings of `esplanade serve`."""

    model_config = SettingsConfigDict(
        env_prefix=SETTINGS.prefix, frozen=True, extra="forbid", validate_default=True
    )

    scene: Path | None = _field("scene")
    world: Path | None = _field("world")
    crowd: Path | None = _field("crowd")
    walls: Path | None = _field("walls")
    fps: float | None = _field("fps")
    unit: str | None = _field("unit")
    scale: float | None = _field("scale")
    columns: str | None = _field("columns")
    strict: bool = _field("strict")
    actors: int = _field("actors")
    roster: Path | None = _field("roster")
    presets: Path | None = _field("presets")
    seed: int = _field("seed")
    tick_rate: int = _field("tick_rate")
    planning_interval: int | None = _field("planning_interval")
    policy: str | None = _field("policy")
    policy_actors: int | None = _field("policy_actors")
    policy_options: str | None = _field("policy_options")

    person_radius_m: float = _field("person_radius_m")
    person_max_speed_mps: float = _field("person_max_speed_mps")
    person_walk_speed_mps: float = _field("person_walk_speed_mps")
    view_radius_m: float = _field("view_radius_m")
    view_limit: int = _field("view_limit")
    steps_radius_m: float = _field("steps_radius_m")
    steps_limit: int = _field("steps_limit")
    viewer_bytes: int = _field("viewer_bytes")
    resume_seconds: float = _field("resume_seconds")

    data: Path | None = _field("data")
    store: SecretStr = _field("store")
    fresh: bool = _field("fresh")
    durable: bool = _field("durable")
    keep_chat: bool = _field("keep_chat")
    keep_chat_days: int = _field("keep_chat_days")
    trajectories: Path | None = _field("trajectories")
    trajectories_hz: float | None = _field("trajectories_hz")
    record: Path | None = _field("record")
    record_names: bool = _field("record_names")
    record_chat: bool = _field("record_chat")
    record_later: bool = _field("record_later")
    record_hours: float = _field("record_hours")
    record_keep_days: float | None = _field("record_keep_days")
    record_keep_gb: float | None = _field("record_keep_gb")

    host: str = _field("host")
    port: int = _field("port")
    tls_cert: Path | None = _field("tls_cert")
    tls_key: Path | None = _field("tls_key")
    root_path: str = _field("root_path")
    public_url: str = _field("public_url")
    private_host: str = _field("private_host")
    private_port: int = _field("private_port")
    private_tls_cert: Path | None = _field("private_tls_cert")
    private_tls_key: Path | None = _field("private_tls_key")
    private_names: str = _field("private_names")
    behind_proxy: bool = _field("behind_proxy")
    trusted_proxies: str = _field("trusted_proxies")
    allowed_origins: str = _field("allowed_origins")

    max_clients: int = _field("max_clients")
    closed: bool = _field("closed")
    world_password: SecretStr = _field("world_password")
    identity_header: str = _field("identity_header")
    hello_timeout_s: float = _field("hello_timeout_s")
    address_sockets: int = _field("address_sockets")
    address_connects: int = _field("address_connects")
    address_joins: int = _field("address_joins")
    address_frames: int = _field("address_frames")
    address_bytes: int = _field("address_bytes")
    answer_bytes: int = _field("answer_bytes")
    message_rate: float = _field("message_rate")
    chat_rate: float = _field("chat_rate")
    slow_bytes: int = _field("slow_bytes")
    drop_bytes: int = _field("drop_bytes")
    drop_seconds: float = _field("drop_seconds")
    operator_commands: int = _field("operator_commands")
    operator_key: SecretStr = _field("operator_key")
    hide_names: bool = _field("hide_names")

    log_format: Literal["console", "json"] = _field("log_format")
    log_level: Literal["debug", "info", "warning", "error"] = _field("log_level")

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
        check({name: getattr(self, name) for name in self.model_fields_set})
        return self
