"""The planted step: how hips and both feet move between footprints."""
