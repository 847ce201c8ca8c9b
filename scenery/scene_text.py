"""The text of scene files that commands write."""

import json

from esplanade.planning import Scene


def scene_text(scene: Scene) -> str:
    """The text of the scene file, with one line for each part so that it is easy to edit."""
    fields = scene.model_dump(mode="json", exclude_defaults=True)
    if any(scene.origin_m):
        fields["origin_m"] = scene.origin_m
    lines = []
    for key, value in fields.items():
        text = json.dumps(value, ensure_ascii=False)
        if value and isinstance(value, list) and isinstance(value[0], dict):
            parts = ",\n".join(f"    {json.dumps(part, ensure_ascii=False)}" for part in value)
            text = f"[\n{parts}\n  ]"
        lines.append(f"  {json.dumps(key)}: {text}")
    return "{\n" + ",\n".join(lines) + "\n}\n"
