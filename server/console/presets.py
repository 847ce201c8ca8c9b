"""Presets: values of parameters that have a name and versions."""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Final

from esplanade.protocol.commands import Facts
from esplanade.protocol.preset_files import PresetFile
from esplanade.server.console.refusals import RefusedError

PRESET: Final = "preset"
"""The field of a subject `preset:NAME`: what holds under the name, None if nothing is saved."""
MOST_NAMES: Final = 256
"""No more presets may be saved."""
MOST_VERSIONS: Final = 64
"""Of more versions of a preset the oldest are forgotten."""


@dataclass(frozen=True)
class Preset:
    """One version of a preset. It never changes."""

    name: str
    version: int
    values: Mapping[str, float | int]
    note: str | None = None
    by: str | None = None
    at_us: int | None = None
    shipped: bool = False

    def plain(self) -> dict[str, Any]:
        """It as plain data."""
        return {**asdict(self), "values": dict(self.values)}


class Presets:
    """Presets that came along with the server, and those that operators have saved over them."""

    def __init__(self, shipped: Iterable[PresetFile] = ()) -> None:
        self._shipped = {
            one.name: Preset(one.name, one.version, one.values, one.note, shipped=True)
            for one in shipped
        }
        self._saved: dict[str, dict[int, Preset]] = {}
        self._heads: dict[str, int | None] = {}
        """The version that holds under each name; None if what was saved is deleted."""

    def all(self) -> list[Preset]:
        """The version of each preset that holds, by name."""
        names = sorted({*self._shipped, *self._saved})
        return [found for name in names if (found := self._head(name)) is not None]

    def found(self, name: str, version: int | None = None) -> Preset:
        """A version of a preset, or the one that holds.

        Raises
        ------
        RefusedError
            There is none.
        """
        found = self._head(name)
        if found is not None and version not in {None, found.version}:
            shipped = self._shipped.get(name)
            found = self._saved.get(name, {}).get(version or 0)
            if found is None and shipped is not None and shipped.version == version:
                found = shipped
        if found is None:
            what = "" if version is None else f" of version {version}"
            text = f"there is no preset {name!r}{what}"
            raise RefusedError.of("unknown_preset", text, preset=name, version=version)
        return found

    def values(self, name: str, version: int | None = None) -> dict[str, float | int]:
        """The values of a preset; see `found`."""
        return dict(self.found(name, version).values)

    def saving(
        self,
        name: str,
        values: Mapping[str, float | int],
        note: str | None,
        by: str | None,
        at_us: int,
    ) -> Facts:
        """The facts of saving values as the next version of a preset.

        Raises
        ------
        RefusedError
            There are too many presets.
        """
        saved = [each for each, head in self._heads.items() if head is not None]
        if name not in saved and len(saved) >= MOST_NAMES:
            raise RefusedError.of("full", f"{MOST_NAMES} presets are saved already", "name")
        made = [
            *self._saved.get(name, {}),
            self._shipped[name].version if name in self._shipped else 0,
        ]
        preset = Preset(name, max(made) + 1, values, note, by, at_us)
        return {f"preset:{name}": {PRESET: preset.plain()}}

    def deleting(self, name: str) -> Facts:
        """The facts of forgetting what was saved under a name.

        Raises
        ------
        RefusedError
            Nothing was.
        """
        if self._heads.get(name) is None:
            if name in self._shipped:
                text = f"{name} came along with the server, and nothing is saved over it"
                raise RefusedError.of("shipped", text, "name", preset=name)
            raise RefusedError.of(
                "unknown_preset", f"there is no preset {name!r}", "name", preset=name
            )
        return {f"preset:{name}": {PRESET: None}}

    def fact(self, name: str) -> dict[str, Any] | None:
        """The preset that holds under a name, as plain data."""
        head = self._heads.get(name)
        return None if head is None else self._saved[name][head].plain()

    def take(self, name: str, value: Mapping[str, Any] | None) -> None:
        """This holds under a name from now on."""
        if value is None:
            self._heads[name] = None
            return
        preset = Preset(**value)
        versions = self._saved.setdefault(name, {})
        versions[preset.version] = preset
        self._heads[name] = preset.version
        for oldest in sorted(versions)[:-MOST_VERSIONS]:
            if oldest != preset.version:
                del versions[oldest]

    def save(self, name: str) -> dict[str, Any] | None:
        """The preset saved under a name, with its versions, as plain data; None if none was."""
        if name not in self._saved:
            return None
        return {
            "head": self._heads[name],
            "versions": [preset.plain() for preset in self._saved[name].values()],
        }

    def load(self, name: str, data: Mapping[str, Any]) -> None:
        """Take in what `save` gave."""
        self._saved[name] = {each["version"]: Preset(**each) for each in data["versions"]}
        self._heads[name] = data["head"]

    def _head(self, name: str) -> Preset | None:
        head = self._heads.get(name)
        return self._shipped.get(name) if head is None else self._saved[name][head]
