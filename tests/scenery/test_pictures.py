"""Pictures: all subjects of a layer, in sizes that fit, with legends."""

from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from esplanade.commandline.errors import UsageError
from esplanade.planning.traversal.stability import Stability
from esplanade.scenery import pictures
from esplanade.scenery.pictures import CLASSES, LayerMap, Marker, draw_layer

needs_matplotlib = pytest.mark.skipif(find_spec("matplotlib") is None, reason="no matplotlib")


def layer(shape: tuple[int, int] = (20, 40)) -> LayerMap:
    rows, columns = np.indices(shape)
    floors = np.where(columns < 30, 0.1 * rows, np.nan)
    classes = np.where(columns < 30, rows % 5, -1).astype(np.int8)
    return LayerMap(
        title="Yard",
        number=3,
        body="1.8 m tall",
        corner=(-2.0, 1.0),
        cell_m=0.25,
        floors=floors,
        reachable=np.isfinite(floors) & (rows < 10),
        classes=classes,
        distance=np.where(rows < 10, floors, np.inf),
        walls=np.array([[0.0, 1.0, 0.0, 3.0]]),
        markers=(Marker("gate", (0.0, 2.0), False), Marker("spawn 0", (1.0, 2.0), True)),
        path_summary="9.5 m",
        path=np.array([[0.0, 2.0], [2.0, 2.0], [3.0, 4.0]]),
        path_layers=np.array([3, 3, 1]),
    )


def test_classes_are_painted_in_the_order_of_their_codes() -> None:
    names = [name.upper().replace("-", "_") for name in CLASSES]
    assert names == [stability.name for stability in sorted(Stability)]


def test_the_extent_is_that_of_the_cells() -> None:
    assert layer().extent == (-2.0, 8.0, 1.0, 6.0)


@needs_matplotlib
@pytest.mark.parametrize("shape", [(20, 40), (60, 4)])
def test_every_subject_becomes_a_file(tmp_path: Path, shape: tuple[int, int]) -> None:
    files = draw_layer(layer(shape), tmp_path)
    assert [file.name for file in files] == [
        "layer-3-heights.png",
        "layer-3-reachability.png",
        "layer-3-classes.png",
        "layer-3-path.png",
    ]
    from matplotlib.image import imread

    for file in files:
        picture = imread(file)
        assert min(picture.shape[:2]) > 100
        assert max(picture.shape[:2]) < 1600
        assert len(np.unique(picture[..., :3].reshape(-1, 3), axis=0)) > 10


@needs_matplotlib
def test_the_path_is_drawn_where_it_leads(tmp_path: Path) -> None:
    from matplotlib.image import imread

    files = draw_layer(layer(), tmp_path)
    picture = imread(files[-1])[..., :3]
    red = np.array([0xD7, 0x19, 0x1C]) / 255.0
    assert (np.abs(picture - red).max(axis=-1) < 0.02).sum() > 200
    assert (np.abs(imread(files[0])[..., :3] - red).max(axis=-1) < 0.02).sum() == 0


def test_without_matplotlib_it_says_what_helps(monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr(pictures, "import_module", absent)
    with pytest.raises(UsageError, match=r"pip install matplotlib.*scene"):
        pictures.require_matplotlib()
