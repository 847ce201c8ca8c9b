"""Places in JSON text are those of an editor."""

import json

from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning.scene.json_places import find_places

TEXT = '{"bounds": [0, 0, 9, 9],\n "walls": [\n  {"start": [1, 2],\n   "end" : [3, "x"]}\n ]\n}'


def test_values_are_found_by_their_path() -> None:
    found = find_places(TEXT, [("walls", 0, "end", 1), ("bounds",), (), ("walls", 0, "height_m")])
    assert found[("walls", 0, "end", 1)] == (4, 16)
    assert found[("bounds",)] == (1, 12)
    assert found[()] == (1, 1)
    assert found[("walls", 0, "height_m")] == (3, 3)


VALUES = st.recursive(
    st.none() | st.booleans() | st.floats(allow_nan=False) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=3), inner),
    max_leaves=12,
)


def paths(value: object, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    parts = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    return [path, *(below for key, part in parts for below in paths(part, (*path, key)))]


@given(VALUES, st.sampled_from([None, 1, 3]), st.booleans())
def test_a_value_stands_where_it_is_found(value: object, indent: int | None, escaped: bool) -> None:
    text = json.dumps(value, indent=indent, ensure_ascii=escaped)
    lines = text.split("\n")
    for path, (line, column) in find_places(text, paths(value)).items():
        part = value
        for step in path:
            part = part[step]  # type: ignore[index]
        rest = "\n".join([lines[line - 1][column - 1 :], *lines[line:]])
        assert json.JSONDecoder(strict=False).raw_decode(rest)[0] == part
