"""Scenes and bodies as people describe them: files, doors, meshes, heights."""
