"""Presets: shipped, saved, applied, taken back, kept."""

from pathlib import Path

import pytest

from esplanade.protocol.preset_files import PresetFileError
from esplanade.server.console.preset_folder import read_presets
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store
from tests.server.conftest import Serving
from tests.server.console.consoles import desk
from tests.server.console.operators import operator
from tests.server.populated import Populated

TIMID = {"op": "apply_preset", "scope": "world", "preset": "timid"}


def test_five_come_along() -> None:
    assert [one.name for one in read_presets(None)] == [
        *("brisk", "courteous", "museum-guide", "rush-hour", "timid"),
    ]
    assert all(one.note for one in read_presets(None))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("name = 3", "name"),
        ('name = "x"\n[values]\nrisk_weight = -1', "values.risk_weight"),
        ('name = "x"\n[values]\nrisky = 1', "values.risky"),
        ('name = "x"\n[values]\nspeed_mps = 3.0', "values: Value error, max_speed_mps"),
        ('name = "x"', "values"),
        ("name", "mine.toml"),
    ],
)
def test_a_faulty_file_is_named_with_its_field(tmp_path: Path, text: str, told: str) -> None:
    (tmp_path / "mine.toml").write_text(text)
    with pytest.raises(PresetFileError, match=r"mine\.toml") as error:
        read_presets(tmp_path)
    assert told in str(error.value)


def test_a_folder_of_ones_own_prevails(tmp_path: Path) -> None:
    (tmp_path / "t.json").write_text(
        '{"name": "timid", "version": 4, "values": {"risk_weight": 40}}'
    )
    (tmp_path / "read.me").write_text("no preset")
    found = {one.name: one for one in read_presets(tmp_path)}
    assert len(found) == 5
    assert found["timid"].version == 4


async def test_a_preset_is_applied_and_taken_back(world: Populated, memory: SqlStore) -> None:
    async with desk(world, memory) as at:
        (answer,) = await at.send(TIMID)
        assert answer.after["world"]["risk_weight"] == 25.0
        assert at.value("main/a2", "risk_weight") == 25.0
        assert at.value("main/a2", "speed_mps") == 1.0
        await at.send({"op": "revert"})
        assert at.value("main/a2", "risk_weight") == 9.5
        await at.send(
            {"op": "set_parameters", "scope": "world", "values": {"wall_weight": 2}},
            {**TIMID, "replace": True},
        )
        assert at.value("main/a2", "wall_weight") == 0.3
        assert (await at.refused({**TIMID, "preset": "bold"})).faults[0].path == [0, "preset"]


async def test_versions_are_added_and_all_of_it_is_taken_back(
    world: Populated, memory: SqlStore
) -> None:
    async with desk(world, memory) as at:
        saved = {"op": "save_preset", "name": "timid"}
        (first,) = await at.send({**saved, "values": {"risk_weight": 30}, "note": "more so"})
        preset = first.after["preset:timid"]["preset"]
        assert (preset["version"], preset["by"], preset["note"]) == (2, "olga", "more so")
        assert first.tick is not None
        await at.send({"op": "set_parameters", "scope": "group:fast", "values": {"foresight_s": 4}})
        await at.send({**saved, "from_scope": "group:fast"}, TIMID)
        assert at.value("main/a2", "foresight_s") == 4.0
        presets = at.console.state.presets
        assert presets.found("timid").version == 3
        assert presets.values("timid", 2) == {"risk_weight": 30.0}
        assert presets.found("timid", 1).shipped
        await at.send({"op": "delete_preset", "name": "timid"})
        assert presets.found("timid").shipped
        assert (await at.refused({"op": "delete_preset", "name": "timid"})).faults[0].code == (
            "shipped"
        )
        await at.send({"op": "revert"})
        assert presets.found("timid").version == 3
        wrong = await at.refused({**saved, "values": {"speed_mps": 3}})
        assert wrong.faults[0].path == [0, "values"]


async def test_what_is_saved_is_there_after_a_restart(world: Populated, tmp_path: Path) -> None:
    saved = {"op": "save_preset", "name": "mine", "values": {"risk_weight": 30}}
    async with open_store(Location.of(tmp_path)) as store, desk(world, store) as at:
        await at.send(saved)
        await at.send({**saved, "values": {"risk_weight": 31}})
        await at.send({**saved, "name": "gone"})
        await at.send({"op": "delete_preset", "name": "gone"})
    async with open_store(Location.of(tmp_path)) as store, desk(world, store) as at:
        presets = at.console.state.presets
        assert presets.values("mine") == {"risk_weight": 31.0}
        assert presets.values("mine", 1) == {"risk_weight": 30.0}
        assert "gone" not in [preset.name for preset in presets.all()]


async def test_over_http_and_who_may(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        vera = await operator(server, "vera", "viewer")
        status, found = await vera.get("/presets")
        assert status == 200
        assert [one["name"] for one in found["presets"]][:2] == ["brisk", "courteous"]
        assert (await vera.get("/presets/timid?version=1"))[1]["values"]["risk_weight"] == 25.0
        assert (await vera.get("/presets/bold"))[0] == 404
        assert (await vera.send(TIMID))[0] == 403
        assert (await olga.send({**TIMID, "preset": "bold"}))[0] == 404
        assert (await olga.send(TIMID))[0] == 200
        assert (await olga.values("actor-1"))["risk_weight"] == 25.0
        status, found = await olga.get("/changes")
        assert found["changes"][0]["can_revert"] is True
        columns = "default,preset:timid,world,actor:actor-1,change:3"
        number = found["changes"][0]["number"]
        status, found = await olga.get(f"/diff?columns={columns.replace('3', str(number))}")
        assert status == 200, found
        (row,) = [row for row in found["rows"] if row["name"] == "risk_weight"]
        assert row == {
            "name": "risk_weight",
            "values": [9.5, 25.0, 25.0, 25.0, 25.0],
            "differs": True,
        }
        assert (await olga.get("/diff?columns=nothing"))[0] == 422
        status, found = await olga.get("/schedules")
        assert {one["name"] for one in found["figures"]} >= {"people", "tick_p99_ms"}
