"""Every setting of `esplanade bots`, in one frozen object.

Values come from the command line, then from environment variables `ESPLANADE_BOTS_<NAME>`, then
from the defaults here. Each field carries its group and unit; `esplanade.bots.cli` makes `--help`
of it.
"""

import math
import os
from pathlib import Path
from typing import Any, Final, Self

from pydantic import Field, field_validator, model_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

from esplanade.bots.address import websocket_url

ENV_PREFIX: Final = "ESPLANADE_BOTS_"

SERVER: Final = "server"
LOAD: Final = "load test (without --replay)"
REPLAY: Final = "replay of a recorded crowd"
RESULT: Final = "result"

CLIENTS_PER_PROCESS: Final = 400
"""Measured: a client at 20 snapshots a second takes about 0.06 % of a core."""


def _option(default: Any, group: str, description: str, unit: str = "", **limits: Any) -> Any:
    extra: dict[str, Any] = {"group": group, "unit": unit}
    return Field(default, description=description, json_schema_extra=extra, **limits)


class BotsSettings(BaseSettings):
    """Settings of `esplanade bots`."""

    model_config = SettingsConfigDict(env_prefix=ENV_PREFIX, frozen=True, extra="forbid")

    url: str = _option(
        "ws://localhost:8080", SERVER, "where the server is; the path /ws is added when absent"
    )

    count: int = _option(20, LOAD, "visitors that join and walk about", ge=1, le=10_000)
    duration: float = _option(
        60.0, LOAD, "how long they stay once all are there; 0 means until Ctrl-C", "s",
        ge=0.0, le=1e6,
    )  # fmt: skip
    seed: int = _option(0, LOAD, "the same seed walks the same ways", ge=0, le=2**32 - 1)
    join_rate: float = _option(50.0, LOAD, "visitors that join", "per second", ge=0.1, le=10_000.0)
    processes: int | None = _option(
        None, LOAD, "processes that share the visitors; without it, as many as they need",
        ge=1, le=64,
    )  # fmt: skip

    replay: Path | None = _option(
        None, REPLAY, "send in the people of this recording (CSV t,id,x,y) instead of visitors"
    )
    speedup: float = _option(
        1.0, REPLAY, "how many times faster than they were recorded", "times", ge=0.1, le=20.0
    )
    limit: int | None = _option(
        None, REPLAY, "only so many of them, in the order in which they come", ge=1
    )
    linger: float = _option(
        0.0, REPLAY, "how long each stands at the end of the way before leaving", "s",
        ge=0.0, le=3600.0,
    )  # fmt: skip

    json_file: Path | None = _option(None, RESULT, "also write all figures here, as JSON")

    @property
    def process_count(self) -> int:
        """Processes for the visitors: enough for them, but one core stays for the server."""
        if self.processes is not None:
            return min(self.processes, self.count)
        spare = max(1, (os.cpu_count() or 1) - 1)
        return min(spare, math.ceil(self.count / CLIENTS_PER_PROCESS))

    @field_validator("url")
    @classmethod
    def _is_an_address(cls, url: str) -> str:
        websocket_url(url)
        return url

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        given = self.model_fields_set
        if self.replay is None:
            misplaced = sorted(given & {"speedup", "limit", "linger"})
            if misplaced:
                raise ValueError(f"{misplaced[0]}: belongs to a replay, but none is given")
        else:
            misplaced = sorted(given & {"count", "duration", "seed", "join_rate", "processes"})
            if misplaced:
                raise ValueError(f"{misplaced[0]}: belongs to a load test, not to a replay")
        return self
