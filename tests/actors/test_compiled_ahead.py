"""The kernels that a second process compiles ahead are those that ticks of a real zone call."""

import pytest

from esplanade.actors import Population
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.agents import ahead
from tests.planning.worlds import COMPILED


@pytest.mark.skipif(not COMPILED, reason="kernels are not compiled here")
def test_kernels_are_compiled_ahead_for_the_types_of_a_real_zone() -> None:
    scene = Scene(bounds=(0.0, 0.0, 6.0, 6.0))
    population = Population(LayeredGrid.from_scene(scene), scene)
    asked = []
    population.warm_up(lambda: asked.append(True))
    population.close()
    assert asked == [True]
    for kernel, kinds in ahead.signatures():
        assert kinds in kernel.signatures, kernel.__name__
