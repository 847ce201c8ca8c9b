"""What makers of scenes need: check a scene, draw it."""
