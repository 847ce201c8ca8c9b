"""Every setting of `esplanade bots`, in one frozen object.

Values come from the command line, then from environment variables `ESPLANADE_BOTS_<NAME>`, then
from the defaults. Defaults, ranges and descriptions stand in `esplanade.bots.options`.
"""

import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Final, Self

from pydantic import SecretStr, field_validator, model_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

from esplanade.bots.address import websocket_url
from esplanade.bots.options import SETTINGS, check
from esplanade.bots.stages import Stage, read_stages
from esplanade.bots.thresholds import Threshold, read_thresholds
from esplanade.commandline import fields

CLIENTS_PER_PROCESS: Final = 400
"""Measured: a client at 20 snapshots a second takes about 0.06 % of a core."""


def _field(name: str) -> Any:
    return fields.field(SETTINGS, name)


class BotsSettings(BaseSettings):
    """Settings of `esplanade bots`."""

    model_config = SettingsConfigDict(env_prefix=SETTINGS.prefix, frozen=True, extra="forbid")

    url: str = _field("url")
    trust: Path | None = _field("trust")
    token: SecretStr = _field("token")

    count: int = _field("count")
    duration: float = _field("duration")
    seed: int = _field("seed")
    join_rate: float = _field("join_rate")
    stages: str | None = _field("stages")
    scenario: str | None = _field("scenario")
    processes: int | None = _field("processes")

    replay: Path | None = _field("replay")
    speedup: float = _field("speedup")
    limit: int | None = _field("limit")
    linger: float = _field("linger")
    fps: float | None = _field("fps")
    unit: str | None = _field("unit")
    scale: float | None = _field("scale")
    columns: str | None = _field("columns")
    strict: bool = _field("strict")

    fail_if: Annotated[tuple[str, ...], NoDecode] = _field("fail_if")
    json_file: Path | None = _field("json_file")
    csv_file: Path | None = _field("csv_file")
    html_file: Path | None = _field("html_file")

    @property
    def plan(self) -> tuple[Stage, ...]:
        """The stages, if there are any."""
        return () if self.stages is None else read_stages(self.stages)

    @property
    def most(self) -> int:
        """The greatest number of visitors at once."""
        return max((stage.bots for stage in self.plan), default=self.count)

    @property
    def thresholds(self) -> tuple[Threshold, ...]:
        """The thresholds of the run."""
        return tuple(each for text in self.fail_if for each in read_thresholds(text))

    @property
    def process_count(self) -> int:
        """Processes for the visitors: enough for them, but one core stays for the server."""
        if self.processes is not None:
            return min(self.processes, self.most)
        spare = max(1, (os.cpu_count() or 1) - 1)
        return min(spare, math.ceil(self.most / CLIENTS_PER_PROCESS))

    @field_validator("url")
    @classmethod
    def _is_an_address(cls, url: str) -> str:
        websocket_url(url)
        return url

    @field_validator("stages")
    @classmethod
    def _are_stages(cls, stages: str | None) -> str | None:
        if stages is not None:
            read_stages(stages)
        return stages

    @field_validator("fail_if", mode="before")
    @classmethod
    def _are_thresholds(cls, given: str | Sequence[str]) -> tuple[str, ...]:
        texts = [given] if isinstance(given, str) else given
        return tuple(each.text for text in texts for each in read_thresholds(text))

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        check({name: getattr(self, name) for name in self.model_fields_set})
        return self
