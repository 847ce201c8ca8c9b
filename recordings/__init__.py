"""Recorded crowds and the walls around them, read from files into plain arrays."""

from esplanade.recordings.crowd import Crowd, Track
from esplanade.recordings.doorways import open_doorways
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.plausibility import Report
from esplanade.recordings.reading import read_crowd
from esplanade.recordings.rows import Given
from esplanade.recordings.walls import Obstacles, Wall, read_obstacles, read_walls, walls_beside

__all__ = [
    "Crowd",
    "Given",
    "Obstacles",
    "RecordingError",
    "Report",
    "Track",
    "Wall",
    "open_doorways",
    "read_crowd",
    "read_obstacles",
    "read_walls",
    "walls_beside",
]
