"""The rehearsal before the first tick: afterwards nothing is left to compile."""

import subprocess
import sys

import numba
import pytest

SERVED_TICKS = """
import gc
from esplanade.planning.compiled.jit import Kernel
from esplanade.server.building import build_world
from esplanade.server.loading import load_scene
from esplanade.server.settings import ServerSettings
from esplanade.server.net.packing import Packing
from esplanade.server.world.audience import Audience
from esplanade.server.world.inputs import Join, Leave, MoveDoor, Steer

def compiled():
    kernels = [each for each in gc.get_objects() if type(each) is Kernel]
    return {(each.py_func.__name__, kinds) for each in kernels for kinds in each.signatures}

settings = ServerSettings(actors=3, log_level="error")
population, world, _ = build_world(load_scene(settings), settings)
before = compiled()
audience, packing = Audience(world.rules, world.origin_m, world.times), Packing()
avatar = 0
for tick in range(60):
    inputs = {5: [Join(0, "Ada", None)], 6: [Steer(avatar, 1, 0.3, 1.0)], 50: [Leave(avatar)]}
    inputs[9] = [MoveDoor(name, not is_open) for name, is_open in world.doors.states().items()]
    if tick == 20:
        for goal in ((30.0, 20.0, 3.5), (13.9, 7.0, 0.0), (-3.0, 0.0, 0.0), (16.2, 6.0, 0.0)):
            search = world.route_search(avatar, goal)
            while not search.advance():
                pass
    world.begin(inputs.get(tick, []))
    frame = world.finish(world.think())
    packing.pack(audience.take(frame).snapshots)
    for _, avatar in frame.joined:
        pass
population.close()
print(len(before) > 20, sorted(name for name, _ in compiled() - before))
"""


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is compiled")
def test_the_first_ticks_of_a_world_compile_nothing() -> None:
    told = subprocess.run(
        [sys.executable, "-c", SERVED_TICKS], capture_output=True, text=True, check=True
    )
    assert told.stdout.split("\n")[-2] == "True []"
