"""The settings of `esplanade serve`: what they are called, mean and may be, without pydantic."""

import re
from collections.abc import Mapping
from ipaddress import ip_address
from typing import Any, Final

from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import (
    SEED_LIMIT,
    Choice,
    Flag,
    Folder,
    InputFile,
    Number,
    OutputFile,
    Text,
    Whole,
)
from esplanade.commandline.recording_settings import READING, check_reading, misplaced
from esplanade.commandline.settings import Setting, Settings, settings_parser
from esplanade.commandline.trajectory_files import check_suffix
from esplanade.server.driving.settings import DRIVING
from esplanade.server.driving.settings import check as check_driving
from esplanade.server.trajectories.rates import ticks_between

_PORT: Final = Whole(0, 65535)
_ROOT_PATH: Final = re.compile(r"(/(?!\.\.?(/|$))[A-Za-z0-9._~-]+)*/?")
_SPEED: Final = Number(0.0, 100.0, above=True)
_WORLD: Final = {
    "scene": Setting(
        "scene to run, a JSON file, or a mesh or plan that one is made of (docs/files.md); without "
        "one, the gallery that comes along",
        InputFile(),
    ),
    "world": Setting(
        "world of several zones that portals join, a JSON file, instead of --scene "
        "(docs/worlds.md)",
        InputFile(),
    ),
    "crowd": Setting(
        "fit the scene to this recorded crowd instead of --scene; docs/files.md lists the formats",
        InputFile(folders=True),
    ),
    "walls": Setting(
        "walls around the crowd; without it, NAME.walls.json beside the crowd's file", InputFile()
    ),
    **READING,
    "actors": Setting("computer-run actors that walk about", Whole(0, 1000), 10),
    "roster": Setting(
        "which actors walk about instead, what each does and how, a JSON file", InputFile()
    ),
    "presets": Setting(
        "folder of presets for operators beside those that come along, one TOML or JSON file each",
        Folder(),
    ),
    "seed": Setting("seed of everything random in the world", Whole(0, SEED_LIMIT), 0),
    "tick_rate": Setting("ticks of the world", Whole(5, 60), 20, "per second"),
    "planning_interval": Setting(
        "ticks from one planning of an actor to its next; without it, a tenth of a second, or more "
        "where the machine does not keep time",
        Whole(1, 4),
        None,
        "ticks",
    ),
    **DRIVING,
}
_PEOPLE: Final = {
    "person_radius_m": Setting("radius of a person", Number(0.05, 1.0), 0.25, "m"),
    "person_max_speed_mps": Setting(
        "fastest a person may move; a crowd raises it to what it needs", _SPEED, 3.0, "m/s"
    ),
    "person_walk_speed_mps": Setting(
        "speed of a person who is sent to a point", _SPEED, 1.6, "m/s"
    ),
    "view_radius_m": Setting(
        "others come into view at this distance, and leave it 15 % further off",
        Number(1.0, 1000.0),
        40.0,
        "m",
    ),
    "view_limit": Setting(
        "most others that one person sees, the nearest first", Whole(1, 4000), 100
    ),
    "steps_radius_m": Setting(
        "steps of others are sent within this distance, and up to 15 % further off to those who "
        "are already sent them",
        Number(1.0, 1000.0),
        25.0,
        "m",
    ),
    "steps_limit": Setting(
        "most others whose steps are sent to one person, the nearest first", Whole(0, 250), 60
    ),
    "viewer_bytes": Setting(
        "snapshots and steps that one person is sent; in a crowd, others are told of less often, "
        "and steps are sent of fewer",
        Whole(4000, 10_000_000),
        12_000,
        "bytes/s",
    ),
    "resume_seconds": Setting(
        "how long a lost connection's avatar stands and waits", Number(0.0, 3600.0), 30.0, "s"
    ),
}
_DATA: Final = {
    "data": Setting(
        "folder of what outlives the process, made if it is not there: the world as it is, its "
        "operators and the audit; "
        "without it, nothing does",
        Folder(),
    ),
    "store": Setting(
        "database for the same in place of a file, postgresql://user:password@host/database; "
        "better set in the environment than here",
        Text(),
        "",
    ),
    "fresh": Setting(
        "begin the world anew instead of going on from where it ended; accounts and the audit stay",
        Flag(),
        default=False,
    ),
    "durable": Setting(
        "what is kept outlives a loss of power too, and each change waits for the disk",
        Flag(),
        default=False,
    ),
    "keep_chat": Setting(
        "keep the last 500 lines of chat for moderators, and who was sent each; without it no "
        "line is kept",
        Flag(),
        default=False,
    ),
    "keep_chat_days": Setting(
        "keep lines of chat for so long in the store too; 0: in memory alone",
        Whole(0, 3650),
        0,
        "days",
    ),
    "trajectories": Setting(
        "file to write where everybody is: .csv, .txt (for PedPy), .sqlite (JuPedSim) or .parquet; "
        "where it is there already, one with a number; names of people are not in it",
        OutputFile(),
    ),
    "trajectories_hz": Setting(
        "samples of trajectories, a part of the ticks; without it, every tick",
        Number(0.01, 60.0),
        None,
        "per second",
    ),
    "record": Setting(
        "folder to record each zone into, one .mcap file each, from which `esplanade replay` runs "
        "it again bit for bit; a file that is there already is left as it is",
        Folder(),
    ),
    "record_names": Setting(
        "names of people stand in recordings; without it, Person 7 and the like do",
        Flag(),
        default=False,
    ),
    "record_chat": Setting(
        "what people say stands in recordings; without it, it is left out", Flag(), default=False
    ),
    "record_later": Setting(
        "record only once an operator says so, in place of from the beginning on",
        Flag(),
        default=False,
    ),
    "record_hours": Setting(
        "a recording has no more of the world than this; the next file goes on from there",
        Number(0.01, 8760.0),
        24.0,
        "hours",
    ),
    "record_keep_days": Setting(
        "recordings that ended longer ago are removed from the folder; without it, none is",
        Number(0.01, 3650.0),
        None,
        "days",
    ),
    "record_keep_gb": Setting(
        "where the recordings of the folder have more, the oldest are removed; never those that "
        "are being written",
        Number(0.001, 1e6),
        None,
        "GB",
    ),
}
RECORD_ONLY: Final = (
    "record_names",
    "record_chat",
    "record_later",
    "record_keep_days",
    "record_keep_gb",
)
"""Settings that belong to `record`."""
_NETWORK: Final = {
    "host": Setting(
        "address for people: web client and WebSocket; empty: every one, of IPv4 and of IPv6",
        Text(),
        "",
    ),
    "port": Setting("port for people; 0 takes a free one", _PORT, 8080),
    "tls_cert": Setting(
        "certificate chain of people's port, PEM; pages are then https:// and the socket wss://; "
        "taken anew when the file changes",
        InputFile(),
    ),
    "tls_key": Setting(
        "private key of the certificate, PEM, without a password; taken anew when the file changes",
        InputFile(),
    ),
    "root_path": Setting(
        "path under which a proxy in front has the world, such as /world; requests without it are "
        "understood too",
        Text(),
        "",
    ),
    "public_url": Setting(
        "address at which people reach the world, for links that are given out; without it, that "
        "of the port for people under the name by which the private port was reached",
        Text(),
        "",
    ),
    "private_host": Setting(
        "address of the port for operators, /healthz, /readyz and /metrics; keep it private, or "
        "encrypt it",
        Text(),
        "127.0.0.1",
    ),
    "private_port": Setting(
        "port for operators, /healthz, /readyz and /metrics; 0 takes a free one", _PORT, 8081
    ),
    "private_tls_cert": Setting(
        "certificate chain of the private port, PEM; where --private-host is none of this machine "
        "alone, that of people's port takes its place",
        InputFile(),
    ),
    "private_tls_key": Setting("private key of that certificate, PEM", InputFile()),
    "private_names": Setting(
        "names by which operators' browsers reach the private port, separated by commas; addresses "
        "and localhost need not be given",
        Text(),
        "",
    ),
    "behind_proxy": Setting(
        "a proxy in front, or the machine around a container, encrypts the private port and keeps "
        "others from it",
        Flag(),
        default=False,
    ),
    "trusted_proxies": Setting(
        "addresses or networks of proxies in front, separated by commas; limits then go by the "
        "address in X-Forwarded-For, to which each of them must append the one that it sees",
        Text(),
        "",
    ),
    "allowed_origins": Setting(
        "origins whose pages may open a WebSocket, separated by commas; empty allows every one",
        Text(),
        "",
    ),
}
_LIMITS: Final = {
    "max_clients": Setting("most people in the world", Whole(1, 4000), 1000),
    "closed": Setting(
        "nobody comes in but by an operator's invitation or pass, a bot's token, the world's "
        "password, or an identity that a proxy in front has checked",
        Flag(),
        default=False,
    ),
    "world_password": Setting(
        "password of a closed world, or its argon2id hash; better set in the environment than "
        "here; empty: there is none",
        Text(),
        "",
    ),
    "identity_header": Setting(
        "header in which a proxy of --trusted-proxies names whoever it has let in, such as "
        "X-Forwarded-User; it lets them into a closed world",
        Text(),
        "",
    ),
    "hello_timeout_s": Setting(
        "a connection must say hello within this time", Number(0.0, 60.0, above=True), 5.0, "s"
    ),
    "address_sockets": Setting(
        "most open connections from one address; an IPv6 network of 64 bits counts as one address, "
        "and 127.0.0.1 and ::1 have no limits as addresses",
        Whole(1, 10_000),
        320,
    ),
    "address_connects": Setting(
        "most new connections from one address within ten seconds", Whole(1, 100_000), 600
    ),
    "address_joins": Setting(
        "most people who may come in from one address within ten seconds", Whole(1, 10_000), 80
    ),
    "address_frames": Setting(
        "WebSocket frames that are taken from one address, of all its clients together; "
        "further ones wait",
        Whole(1, 1_000_000),
        3000,
        "per second",
    ),
    "address_bytes": Setting(
        "most bytes of pages and data under way to one address that are not read yet",
        Whole(32 * 1024, 1024**3),
        2 * 1024**2,
        "bytes",
    ),
    "answer_bytes": Setting(
        "most bytes of pages and data under way to all addresses that are not read yet",
        Whole(32 * 1024, 1024**3),
        16 * 1024**2,
        "bytes",
    ),
    "message_rate": Setting(
        "messages a client may send for long; twice this in a burst; every WebSocket frame counts, "
        "and five more a second are granted for pongs",
        Number(1.0, 10_000.0),
        60.0,
        "per second",
    ),
    "chat_rate": Setting(
        "lines a person may say for long; five in a burst", Number(0.01, 100.0), 1.0, "per second"
    ),
    "slow_bytes": Setting(
        "a client with more unsent than this gets no snapshots",
        Whole(1024, 16 * 1024**2),
        32 * 1024,
        "bytes",
    ),
    "drop_bytes": Setting(
        "a client with more unsent than this is dropped",
        Whole(1024, 64 * 1024**2),
        256 * 1024,
        "bytes",
    ),
    "drop_seconds": Setting(
        "a client that stays slow for this time is dropped", Number(0.0, 600.0, above=True), 5.0,
        "s",
    ),
    "operator_commands": Setting(
        "commands that one operator's account may send; a twelfth of this within a second",
        Whole(1, 1_000_000),
        60,
        "per minute",
    ),
    "operator_key": Setting(
        "who says this key may open and close doors and come in anywhere; better set in the "
        "environment than here; "
        "empty: nobody",
        Text(),
        "",
    ),
    "hide_names": Setting(
        "operators who do not moderate are not told the names of people",
        Flag(),
        default=False,
    ),
}  # fmt: skip
_LOGS: Final = {
    "log_format": Setting("lines for people or JSON", Choice("console", "json"), "console"),
    "log_level": Setting(
        "least level that is logged", Choice("debug", "info", "warning", "error"), "info"
    ),
}


def check(given: Mapping[str, Any]) -> None:
    """Check that these settings fit together, all others being as they are by default.

    Raises
    ------
    ValueError
        They do not; the message says which.
    """
    if given.get("scene") and given.get("crowd"):
        raise ValueError("scene and crowd: give one of them, not both")
    _check_world(given)
    if given.get("roster") and given.get("actors") is not None:
        raise ValueError("roster and actors: give one of them, not both")
    if given.get("walls") and not given.get("crowd"):
        raise ValueError("walls: they belong to a crowd, but none is given")
    if not given.get("crowd") and (name := misplaced(given)):
        raise ValueError(f"{name}: it says how a crowd is read, but none is given")
    check_reading(given)
    _check_trajectories(given)
    check_driving(given)
    for name in RECORD_ONLY:
        if given.get(name) and not given.get("record"):
            raise ValueError(f"{name}: it belongs to --record, but none is given")
    if bool(given.get("tls_cert")) != bool(given.get("tls_key")):
        raise ValueError("tls_cert and tls_key: give both of them, or none")
    _check_ways_in(given)
    if given.get("keep_chat_days") and not given.get("keep_chat"):
        raise ValueError("keep_chat_days: it needs keep_chat, which keeps chat at all")
    if not _ROOT_PATH.fullmatch(given.get("root_path", "")):
        raise ValueError(
            f"root_path: {given['root_path']!r} is no path such as /world, of letters, digits "
            "and - . _ ~"
        )
    if given.get("trusted_proxies"):
        from esplanade.server.net.addresses import TrustedProxies  # noqa: PLC0415

        TrustedProxies(given["trusted_proxies"])
    slow_bytes = given.get("slow_bytes", _LIMITS["slow_bytes"].default)
    if given.get("drop_bytes", _LIMITS["drop_bytes"].default) <= slow_bytes:
        raise ValueError("drop_bytes: must be greater than slow_bytes")


_SAID_BY_WORLD: Final = ("scene", "crowd", "roster")


def _check_world(given: Mapping[str, Any]) -> None:
    if not given.get("world"):
        return
    for name in _SAID_BY_WORLD:
        if given.get(name) is not None:
            raise ValueError(f"world and {name}: the world's file says that for each zone")


def _check_trajectories(given: Mapping[str, Any]) -> None:
    path, hz = given.get("trajectories"), given.get("trajectories_hz")
    if hz is not None and path is None:
        raise ValueError("trajectories_hz: it belongs to --trajectories, but none is given")
    try:
        if path is not None:
            check_suffix(path)
    except ValueError as error:
        raise ValueError(f"trajectories: {error}") from None
    try:
        ticks_between(given.get("tick_rate", _WORLD["tick_rate"].default), hz)
    except ValueError as error:
        raise ValueError(f"trajectories_hz: {error}") from None


def is_loopback(host: str) -> bool:
    """Whether an address to listen at is reached from this machine alone."""
    try:
        return ip_address(host.partition("%")[0]).is_loopback
    except ValueError:
        return host == "localhost"


def _check_ways_in(given: Mapping[str, Any]) -> None:
    if bool(given.get("private_tls_cert")) != bool(given.get("private_tls_key")):
        raise ValueError("private_tls_cert and private_tls_key: give both of them, or none")
    encrypted = given.get("private_tls_cert") or given.get("tls_cert")
    host = given.get("private_host", "127.0.0.1")
    if not (is_loopback(host) or encrypted or given.get("behind_proxy")):
        raise ValueError(
            f"private_host: at {host!r} operators' passwords and tokens would go over the network "
            "without encryption; give --private-tls-cert and --private-tls-key, or --behind-proxy "
            "if something in front encrypts"
        )
    if not given.get("closed") and (given.get("world_password") or given.get("identity_header")):
        raise ValueError("world_password, identity_header: they belong to a world that is --closed")
    header = given.get("identity_header", "")
    if header and not given.get("trusted_proxies"):
        raise ValueError("identity_header: say by --trusted-proxies whose word is taken")
    if header and not re.fullmatch(r"[A-Za-z0-9-]+", header):
        raise ValueError(f"identity_header: {header!r} is no name of a header")
    url = given.get("public_url", "")
    if url and not re.fullmatch(r"https?://[^\s#?/]+(/[^\s#?]*)?", url):
        raise ValueError(f"public_url: {url!r} is no address such as https://world.example.org/")


SETTINGS: Final = Settings(
    "ESPLANADE_",
    {
        "world": _WORLD,
        "people": _PEOPLE,
        "data": _DATA,
        "network": _NETWORK,
        "limits on clients": _LIMITS,
        "logs": _LOGS,
    },
    check,
)


def parser(prog: str = "esplanade serve") -> Parser:
    """The options of `esplanade serve`."""
    return settings_parser(
        prog,
        SETTINGS,
        run="esplanade.server.cli:run",
        description="Run a world for people and actors.",
        epilog="""\
examples:
  esplanade serve                                  the gallery, with ten actors
  esplanade serve --scene scenes/plaza.json --actors 30 --port 9000
  esplanade serve --world scenes/town.json         several zones, and portals between them
  esplanade serve --data world                     the world goes on from there after a restart
  esplanade serve --record kept              then `esplanade replay kept/Gallery.mcap`
  esplanade serve --crowd zara1.csv                then `esplanade bots --replay zara1.csv`

Every option can also be given as an environment variable: --tick-rate is ESPLANADE_TICK_RATE.
The command line wins.

exit code: 0 ended in good order, 1 a port or the store cannot be had, 2 wrong usage, or a
scene that cannot be run, 130 Ctrl-C before the world was open""",
    )
