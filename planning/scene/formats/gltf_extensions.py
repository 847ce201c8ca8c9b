"""Extensions of glTF: those that are read, those that change no geometry, and the rule for others.

The specification: who does not know a required extension must refuse the file. One that is only
used may be passed over, as long as it changes no geometry or the file has a fallback.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, Final

INSTANCING: Final = "EXT_mesh_gpu_instancing"
DRACO: Final = "KHR_draco_mesh_compression"
MESHOPT: Final = ("EXT_meshopt_compression", "KHR_meshopt_compression")
QUANTISED: Final = "KHR_mesh_quantization"
READ: Final = frozenset((INSTANCING, DRACO, *MESHOPT, QUANTISED))

_APPEARANCE: Final = re.compile(
    r"(KHR|EXT|MSFT|ADOBE|ASOBO|NV|GODOT|VRMC?|GOOGLE|WEB3D|GRIFFEL|OMI|MOZ|CESIUM|AGI)_"
    r"(materials?|texture|lights?|xmp|audio|sky|environment|image|emitter)[a-z0-9]*(_\w+)?$"
    r"|(KHR|EXT)_(techniques|animation|physics)\w*$|OMI_\w+$|KHR_implicit_shapes$",
    re.IGNORECASE,
)
"""Materials, textures, lights, sounds, bodies of physics and data about the file, of any maker."""
_HARMLESS: Final = frozenset(
    (
        "EXT_mesh_features",
        "EXT_instance_features",
        "EXT_structural_metadata",
        "EXT_feature_metadata",
        "EXT_mesh_manifold",
        "EXT_mesh_primitive_edge_visibility",
        "CESIUM_primitive_outline",
        "FB_geometry_metadata",
        "FB_ngon_encoding",
        "KHR_node_selectability",
        "KHR_node_hoverability",
        "KHR_mesh_primitive_outline",
        "MSFT_packing_occlusionRoughnessMetallic",
        "MSFT_packing_normalRoughnessMetallic",
        "MSFT_lod",
        "MSFT_screencoverage",
        "MOZ_hubs_components",
        "KHR_interactivity",
        "VRM",
    )
)
"""They change no geometry, or the file has what stands in their place: of `MSFT_lod` the finest."""
_GEOMETRY: Final = re.compile(
    r"mesh|geometr|instanc|compress|quantiz|displace|subdiv|tessel|voxel|splat|curve|surface|shape"
    r"|articulation|rtc|tile|terrain|extern|visib|transform|primitive|parametric|cad|proto|region",
    re.IGNORECASE,
)
"""Words in the name of an extension that changes geometry; others are about something else."""


def check_extensions(content: dict[str, Any]) -> tuple[str, ...]:
    """Refuse what cannot be read rightly; returns the unknown extensions that may be passed over.

    Raises
    ------
    ValueError
        A required extension is unknown, or one changes geometry.
    """
    required = _names(content, "extensionsRequired")
    unknown = [name for name in required if not _known(name)]
    if unknown:
        raise ValueError(f"it requires {', '.join(unknown)}, unknown here: save it without")
    used = [*_names(content, "extensionsUsed"), *sorted(_present(content))]
    others = tuple(dict.fromkeys(name for name in used if not _known(name)))
    changing = [name for name in others if _GEOMETRY.search(name)]
    if changing:
        raise ValueError(
            f"it uses {', '.join(changing)}, which changes its geometry and is unknown here: "
            "save it without"
        )
    return others


def requires(content: dict[str, Any], name: str) -> bool:
    """Whether a file can be read with this extension only; else it has what stands in its place."""
    return name in _names(content, "extensionsRequired")


def _known(name: str) -> bool:
    return name in READ or name in _HARMLESS or bool(_APPEARANCE.match(name))


def _names(content: dict[str, Any], key: str) -> list[str]:
    names = content.get(key, ())
    if not isinstance(names, list | tuple) or not all(isinstance(name, str) for name in names):
        raise ValueError(f"its {key} are no list of names")
    return list(names)


def _present(content: dict[str, Any]) -> set[str]:
    """Extensions of nodes, meshes, accessors and buffers that the file uses without naming them."""
    found: set[str] = set()
    for key in ("nodes", "meshes", "accessors", "bufferViews", "buffers"):
        for part in _objects(content.get(key)):
            found.update(_objects_names(part))
            for primitive in _objects(part.get("primitives")):
                found.update(_objects_names(primitive))
    return found


def _objects(parts: Any) -> Iterable[dict[str, Any]]:
    return (part for part in parts if isinstance(part, dict)) if isinstance(parts, list) else ()


def _objects_names(part: dict[str, Any]) -> Iterable[str]:
    extensions = part.get("extensions")
    return extensions if isinstance(extensions, dict) else ()
