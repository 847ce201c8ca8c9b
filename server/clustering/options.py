"""The options of `esplanade zone` and `esplanade gateway`, without pydantic."""

from collections.abc import Mapping
from typing import Any, Final

from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import InputFile, Text, Whole
from esplanade.commandline.settings import Setting, Settings, settings_parser
from esplanade.server.options import SETTINGS as SERVER
from esplanade.server.options import check as check_server

CLUSTER: Final = {
    "store": Setting(
        "database of the cluster, postgresql://user:password@host/database; better set in the "
        "environment than here",
        Text(),
        "",
    ),
    "nats": Setting(
        "NATS servers that carry frames and inputs, separated by commas, such as "
        "nats://127.0.0.1:4222, or tls://broker:4222 with encryption",
        Text(),
        "nats://127.0.0.1:4222",
    ),
    "nats_login": Setting(
        "file with the user on its first line and the password on its second; without it, those of "
        "ESPLANADE_NATS_USER and ESPLANADE_NATS_PASSWORD, if there are any",
        InputFile(),
    ),
    "nats_ca": Setting(
        "certificates by which NATS servers at tls://… are trusted, PEM; without it, those that "
        "the system trusts",
        InputFile(),
    ),
    "nats_cert": Setting("certificate by which NATS servers know this process, PEM", InputFile()),
    "nats_key": Setting("private key of that certificate, PEM", InputFile()),
    "name": Setting(
        "name of this process in the cluster, which no other has: a-z, 0-9 and -; without it, the "
        "name of the machine and a few letters",
        Text(),
        "",
    ),
    "health_host": Setting("address of /healthz, /readyz and /metrics", Text(), "127.0.0.1"),
    "health_port": Setting(
        "port of /healthz, /readyz and /metrics; 0 takes a free one", Whole(0, 65535), 0
    ),
}


def _of_server(group: str, *names: str) -> dict[str, Setting]:
    chosen = SERVER.groups[group]
    return {name: chosen[name] for name in names or chosen}


_PORTS: Final = (
    "host",
    "port",
    "tls_cert",
    "tls_key",
    "root_path",
    "public_url",
    "trusted_proxies",
    "allowed_origins",
)
_LIMITS: Final = (
    "max_clients",
    "hello_timeout_s",
    "address_sockets",
    "address_connects",
    "address_joins",
    "address_frames",
    "address_bytes",
    "answer_bytes",
    "message_rate",
    "chat_rate",
    "slow_bytes",
    "drop_bytes",
    "drop_seconds",
    "operator_key",
)


_ADMISSION: Final = ("closed", "world_password", "identity_header")
_PRIVATE: Final = (
    "private_host",
    "private_port",
    "private_tls_cert",
    "private_tls_key",
    "private_names",
    "behind_proxy",
)


def _private() -> dict[str, Setting]:
    """The options of operators' port; gateways on one machine take free ones by default."""
    found = _of_server("network", *_PRIVATE)
    return {**found, "private_port": found["private_port"]._replace(default=0)}


def _check(given: Mapping[str, Any]) -> None:
    if not given.get("store"):
        raise ValueError(
            "store: say where the database of the cluster is, --store postgresql://… or "
            "ESPLANADE_STORE"
        )
    check_server({name: value for name, value in given.items() if name not in CLUSTER})


ZONE: Final = Settings(
    "ESPLANADE_",
    {
        "cluster": CLUSTER,
        "world": _of_server("world", "actors", "seed", "tick_rate", "planning_interval"),
        "people": {**_of_server("people"), **_of_server("limits on clients", "max_clients")},
        "operators": {
            **_of_server("world", "presets"),
            **_of_server("limits on clients", "operator_commands", "hide_names"),
            **_of_server("data", "keep_chat", "keep_chat_days"),
        },
        "data": _of_server(
            "data",
            "record",
            "record_names",
            "record_chat",
            "record_later",
            "record_hours",
            "record_keep_days",
            "record_keep_gb",
        ),
        "logs": _of_server("logs"),
    },
    _check,
)
GATEWAY: Final = Settings(
    "ESPLANADE_",
    {
        "cluster": CLUSTER,
        "network": _of_server("network", *_PORTS),
        "operators": _private(),
        "limits on clients": {
            **_of_server("limits on clients", *_ADMISSION, *_LIMITS),
            **_of_server("people", "resume_seconds"),
        },
        "logs": _of_server("logs"),
    },
    _check,
)


def zone() -> Parser:
    """The options of `esplanade zone`."""
    made = settings_parser(
        "esplanade zone",
        ZONE,
        run="esplanade.server.clustering.cli:zone",
        description="""\
Run a zone of a world on several machines: the process claims one that nobody owns, simulates it,
and takes part in no other. Where all have owners it stands by, and takes over within seconds when
an owner dies. The world is the one that `esplanade cluster init` has put into the database.""",
        epilog="""\
examples:
  esplanade zone --store postgresql://esplanade@db/world --nats nats://broker:4222
  esplanade zone plaza                      claims no other zone
  esplanade zone --name ash                 the name by which it can be moved to and drained

Start one for each zone, and one or more that stand by. All of them take the same options. Ctrl-C
and SIGTERM give the zone back: who stands by goes on with it within a second.

Every option can also be given as an environment variable: --store is ESPLANADE_STORE.

exit code: 0 ended in good order, 1 the database or the broker cannot be reached, 2 wrong usage, or
a zone that cannot be run, 130 Ctrl-C before it was ready""",
    )
    made.usage = "esplanade zone [ZONE ...] [options]"
    made.add_argument(
        "zones", metavar="ZONE", nargs="*", type=Text(), default=[], help="zones that it may claim"
    )
    return made


def gateway() -> Parser:
    """The options of `esplanade gateway`."""
    return settings_parser(
        "esplanade gateway",
        GATEWAY,
        run="esplanade.server.clustering.cli:gateway",
        description="""\
Let people into a world on several machines: the process serves the web client and has people's
connections, wherever their zones are. There may be any number of gateways behind one name; who
loses a connection comes back at any of them.""",
        epilog="""\
examples:
  esplanade gateway --store postgresql://esplanade@db/world --nats nats://broker:4222
  esplanade gateway --port 8090 --name east

Every option can also be given as an environment variable: --store is ESPLANADE_STORE.

exit code: 0 ended in good order, 1 the database, the broker or the port cannot be had, 2 wrong
usage, 130 Ctrl-C before it was open""",
    )
