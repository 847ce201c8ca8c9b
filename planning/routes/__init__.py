"""Routes over static ground: potentials of goals, shortest paths, storeys."""
