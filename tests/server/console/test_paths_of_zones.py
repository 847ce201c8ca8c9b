"""A gateway answers what is about the world, and hands everything about a zone on."""

import re
from typing import cast

from fastapi import FastAPI

from esplanade.server.console import zones_api
from esplanade.server.console.api import OF_WORLD, add_api, is_about_zone
from esplanade.server.console.gate import Gate


def test_every_path_of_the_interface_is_about_a_zone_or_about_the_world() -> None:
    whole, world = FastAPI(), FastAPI()
    add_api(whole, cast(Gate, None))
    add_api(world, cast(Gate, None), (*OF_WORLD, zones_api.router))
    paths, of_world = set(whole.openapi()["paths"]), set(world.openapi()["paths"])
    assert {"/api/v1/login", "/api/v1/audit", "/api/v1/zones"} < of_world < paths
    for path in paths:
        assert is_about_zone(re.sub(r"\{\w+\}", "name", path)) == (path not in of_world), path
    assert is_about_zone("/api/v1/live")
    assert not is_about_zone("/console/")
