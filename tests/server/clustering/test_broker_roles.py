"""Hosts and gateways log in at an encrypted broker, and each may do what it needs and no more."""

import asyncio
from collections.abc import Iterator
from pathlib import Path

import pytest
from nats.aio.msg import Msg
from tools.environments import ROOT

from esplanade.protocol.messages import Chat, ChatLine, Travel
from esplanade.server.link.broker import BrokerError, connected
from esplanade.server.link.broker_login import BrokerLogin
from esplanade.server.link.subjects import Subjects
from tests.patience import PATIENCE_S
from tests.server.brokers import NatsServer, nats_server
from tests.server.certificates import Pair, make_pair
from tests.server.client import joined
from tests.server.clustering.clusters import Cluster, cluster
from tests.server.clustering.people import sees, walk
from tests.server.databases import PostgresqlServer, new_database
from tests.server.zones import BEFORE_GATE

PASSWORDS = {"zone": "secretOfHosts1", "gateway": "secretOfGateways2"}
CONFIGURATION = ROOT / "deploy/nats/esplanade.conf"
PLACE = (6.0, 10.0, 0)
SUBJECTS = Subjects("town-1")


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> Pair:
    return make_pair(tmp_path_factory.mktemp("broker"), "broker")


@pytest.fixture(scope="module")
def guarded(pair: Pair) -> Iterator[NatsServer]:
    """A broker with the users of `deploy/nats`, which speaks TLS."""
    environment = {
        "NATS_ZONE_PASSWORD": PASSWORDS["zone"],
        "NATS_GATEWAY_PASSWORD": PASSWORDS["gateway"],
    }
    words = ("--config", str(CONFIGURATION), "--tls", "--tlscert", str(pair.cert))
    with nats_server(*words, "--tlskey", str(pair.key), environment=environment) as server:
        yield server


@pytest.fixture(scope="module")
def town_of_roles(
    database: PostgresqlServer, guarded: NatsServer, pair: Pair, town: Path
) -> Iterator[Cluster]:
    with cluster(new_database(database.address), guarded) as made:
        encrypted = guarded.address.replace("nats://", "tls://")
        for role, password in PASSWORDS.items():
            made.login[role] = {
                "ESPLANADE_NATS": encrypted,
                "ESPLANADE_NATS_CA": str(pair.cert),
                "ESPLANADE_NATS_USER": role,
                "ESPLANADE_NATS_PASSWORD": password,
            }
        made.init(town)
        yield made


def login(role: str, pair: Pair) -> BrokerLogin:
    return BrokerLogin(role, PASSWORDS[role], pair.cert)


async def test_a_world_runs_with_no_more_than_its_roles_may(town_of_roles: Cluster) -> None:
    made = town_of_roles
    await asyncio.to_thread(made.settle)
    east, west = made.gateways
    olga = made.operator("admin", east, "yard")
    async with joined(east.port, "Ann", BEFORE_GATE) as ann, joined(west.port, "Ben", PLACE) as ben:
        await walk(ben, 1.0)
        await sees(ann, ben)
        await ben.send(ChatLine(text="hello"))
        assert (await ann.until(Chat)).text == "hello"
        command = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}}
        status, answer = await olga.send(command)
        assert status == 200, answer
        assert (await olga.values("yard/actor-1"))["risk_weight"] == 12.0
        await ann.move(0.0, 1.5)
        assert (await ann.until(Travel)).zone == "hall"
        epoch = made.owner("yard")[1]
        made.owning("yard").kill()
        await made.taken_over("yard", epoch)
        await ben.ticks(40)
    lines = [str(line) for process in made.processes for line in process.lines]
    assert not [line for line in lines if "forbids" in line]
    assert not [line for line in lines if any(secret in line for secret in PASSWORDS.values())]


@pytest.mark.parametrize(
    ("role", "subject"),
    [
        ("gateway", SUBJECTS.frames("yard")),
        ("gateway", SUBJECTS.control),
        ("zone", SUBJECTS.calls("yard", 7)),
        ("zone", SUBJECTS.inputs("yard")),
    ],
)
async def test_nobody_says_what_is_another_s_to_say(
    guarded: NatsServer, pair: Pair, role: str, subject: str
) -> None:
    heard: list[bytes] = []
    listener = {SUBJECTS.frames("yard"): "gateway", SUBJECTS.control: "gateway"}.get(
        subject, "zone"
    )
    speaker = {"zone": "gateway", "gateway": "zone"}[role]
    async with (
        connected([guarded.address], "forger", login(role, pair)) as forger,
        connected([guarded.address], "speaker", login(speaker, pair)) as right,
        connected([guarded.address], "listener", login(listener, pair)) as listening,
    ):

        async def take(message: Msg) -> None:
            heard.append(message.data)

        await listening.subscribe(subject, cb=take)
        await listening.flush()
        await forger.publish(subject, b"a forgery")
        await forger.flush()
        await right.publish(subject, b"the truth")
        async with asyncio.timeout(PATIENCE_S):
            while not heard:  # noqa: ASYNC110 - nothing tells of it
                await asyncio.sleep(0.01)
        assert heard == [b"the truth"]


@pytest.mark.parametrize("name", ["gateway", "zone"])
async def test_who_has_no_login_is_refused_and_no_secret_is_told(
    guarded: NatsServer, pair: Pair, name: str
) -> None:
    for wrong in (BrokerLogin(authority=pair.cert), BrokerLogin(name, "a wrong secret", pair.cert)):
        with pytest.raises(BrokerError, match="--nats-login") as refused:
            async with connected([guarded.address], "stranger", wrong):
                pass
        assert "wrong secret" not in str(refused.value) + repr(wrong)
    trusting_others = BrokerLogin(name, PASSWORDS[name])
    address = guarded.address.replace("nats://", "tls://")
    with pytest.raises(BrokerError, match=r"(?i)certificate"):
        async with connected([address], "stranger", trusting_others):
            pass


def test_a_login_is_read_from_a_file_or_the_environment(tmp_path: Path) -> None:
    file = tmp_path / "login"
    file.write_text("zone\nnobody guesses this\n")
    named = {"ESPLANADE_NATS_USER": "gateway", "ESPLANADE_NATS_PASSWORD": "nor this"}
    assert BrokerLogin.of({}, file).settings(("nats://a:1",)) == {
        "user": "zone",
        "password": "nobody guesses this",
    }
    assert BrokerLogin.of(named, None).user == "gateway"
    assert BrokerLogin.of({}, None).settings(("nats://a:1",)) == {}
    for text in ("zone", "zone\n\n", "zone\nsecret\nmore\n", ""):
        file.write_text(text)
        with pytest.raises(ValueError, match="password on its second") as refused:
            BrokerLogin.of({}, file)
        assert "secret" not in str(refused.value)
    with pytest.raises(ValueError, match="ESPLANADE_NATS_PASSWORD: give both"):
        BrokerLogin.of({"ESPLANADE_NATS_USER": "zone"}, None)
    with pytest.raises(ValueError, match="nats_cert and nats_key"):
        BrokerLogin.of({}, None, certificate=file)
    with pytest.raises(ValueError, match="cannot be read: No such file"):
        BrokerLogin.of({}, tmp_path / "none")
