"""What makers of scenes need: check a scene, draw it, make one of a mesh."""
