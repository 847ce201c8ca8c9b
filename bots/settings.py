"""Every setting of `esplanade bots`, in one frozen object.

Values come from the command line, then from environment variables `ESPLANADE_BOTS_<NAME>`, then
from the defaults. Defaults, ranges and descriptions stand in `esplanade.bots.options`.
"""

import math
import os
from pathlib import Path
from typing import Any, Final, Self

from pydantic import field_validator, model_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

from esplanade.bots.address import websocket_url
from esplanade.bots.options import SETTINGS, check
from esplanade.commandline import fields

CLIENTS_PER_PROCESS: Final = 400
"""Measured: a client at 20 snapshots a second takes about 0.06 % of a core."""


def _field(name: str) -> Any:
    return fields.field(SETTINGS, name)


class BotsSettings(BaseSettings):
    """Settings of `esplanade bots`."""

    model_config = SettingsConfigDict(env_prefix=SETTINGS.prefix, frozen=True, extra="forbid")

    url: str = _field("url")

    count: int = _field("count")
    duration: float = _field("duration")
    seed: int = _field("seed")
    join_rate: float = _field("join_rate")
    processes: int | None = _field("processes")

    replay: Path | None = _field("replay")
    speedup: float = _field("speedup")
    limit: int | None = _field("limit")
    linger: float = _field("linger")

    json_file: Path | None = _field("json_file")

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
        check({name: getattr(self, name) for name in self.model_fields_set})
        return self
