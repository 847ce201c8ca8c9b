"""Recorded crowds and the walls around them, read from files into plain arrays."""

from recordings.crowd import Crowd, Track
from recordings.doorways import open_doorways
from recordings.errors import RecordingError
from recordings.reading import read_crowd
from recordings.walls import Obstacles, Wall, read_obstacles, read_walls, walls_beside

__all__ = [
    "Crowd",
    "Obstacles",
    "RecordingError",
    "Track",
    "Wall",
    "open_doorways",
    "read_crowd",
    "read_obstacles",
    "read_walls",
    "walls_beside",
]
