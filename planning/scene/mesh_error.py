"""The error of all that reads meshes."""


class MeshError(ValueError):
    """A file that holds no mesh to walk on; says what is wrong with it."""
