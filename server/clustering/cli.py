"""`esplanade zone` and `esplanade gateway`: run a process of a cluster, or say why they cannot."""

import asyncio
from argparse import Namespace
from collections.abc import Callable, Coroutine
from importlib.util import find_spec
from typing import Any

from esplanade.commandline import exit_codes, fields
from esplanade.commandline.errors import CommandError, UsageError
from esplanade.commandline.running import imported
from esplanade.commandline.settings import Settings, given_settings
from esplanade.server import logs
from esplanade.server.clustering.membership import Membership
from esplanade.server.clustering.options import CLUSTER, GATEWAY, ZONE
from esplanade.server.loading import LoadingError
from esplanade.server.net.tls import TlsError
from esplanade.server.settings import ServerSettings
from esplanade.server.store.store import StoreError

Work = Callable[[], Coroutine[Any, Any, None]]


def zone(options: Namespace) -> int:
    """Run a host as the options say; returns the exit code."""
    settings, membership = _settings(options, ZONE)
    run_host = imported("esplanade.server.clustering.running:run_host")  # it needs an extra
    return _run(settings, lambda: run_host(settings, membership, options.zones))


def gateway(options: Namespace) -> int:
    """Run a gateway as the options say; returns the exit code."""
    settings, membership = _settings(options, GATEWAY)
    run_gateway = imported("esplanade.server.clustering.running:run_gateway")
    return _run(settings, lambda: run_gateway(settings, membership))


def _settings(options: Namespace, table: Settings) -> tuple[ServerSettings, Membership]:
    if find_spec("nats") is None:
        raise CommandError("a world on several machines needs nats-py: install esplanade[cluster]")
    given = given_settings(options, table)
    try:
        said = {name: given.pop(name, each.default) for name, each in CLUSTER.items()}
        membership = Membership.of(**said)
    except ValueError as error:
        raise UsageError(str(error)) from None
    # Variables of a server that is the whole world mean nothing here.
    alone = {"store": "", "data": None, "scene": None, "world": None, "crowd": None}
    if "private_port" in (name for group in table.groups.values() for name in group):
        alone["private_port"] = table.setting("private_port").default
    return fields.made(ServerSettings, {**alone, **given}), membership


def _run(settings: ServerSettings, work: Work) -> int:
    try:
        with logs.written(settings):
            try:
                import uvloop  # noqa: PLC0415
            except ImportError:  # there is none for Windows
                asyncio.run(work())
            else:
                uvloop.run(work())
    except (LoadingError, TlsError) as error:
        raise UsageError(str(error)) from None
    except (StoreError, ConnectionError) as error:
        raise CommandError(str(error)) from None
    except OSError as error:
        where = f"{settings.host}:{settings.port}"
        raise CommandError(f"cannot listen on {where}: {error.strerror or error}") from None
    return exit_codes.OK
