"""The policy of a served zone: begun with it, and ended with it."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from esplanade.policies.errors import PolicyError
from esplanade.server.driving.drivers import Drivers
from esplanade.server.driving.settings import options_of
from esplanade.server.loading import LoadingError
from esplanade.server.metrics import Metrics
from esplanade.server.settings import ServerSettings
from esplanade.server.world.zone import Zone


@asynccontextmanager
async def drivers_of(
    settings: ServerSettings, zone: Zone, metrics: Metrics
) -> AsyncIterator[Drivers | None]:
    """Those who ask the policy of the settings, if there is one; it is tried out before.

    Raises
    ------
    LoadingError
        The policy cannot be made.
    """
    if settings.policy is None:
        yield None
        return
    drivers = Drivers(zone, settings.policy, options_of(settings.policy_options), metrics)
    try:
        try:
            await asyncio.to_thread(drivers.start)
        except PolicyError as error:
            raise LoadingError(str(error)) from None
        yield drivers
    finally:
        await asyncio.to_thread(drivers.close)
