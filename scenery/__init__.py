"""Tools for authors of scenes: they check a scene, draw it, or make one of a mesh."""
