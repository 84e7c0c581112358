"""Exact, parallel Delaunay triangulations, and parallel rendering.

    >>> import numpy, delray
    >>> points = numpy.random.default_rng(1).random((1000, 2))
    >>> mesh = delray.Delaunay(points)
    >>> mesh.simplices.shape[1]
    3

Triangulations: Delaunay, Dynamic, triangulate, interpolate, voronoi, hull, quality, verify,
simplify_terrain. Files: read_points, read_mesh, write_mesh. Pictures: Scene, Camera, render,
Renderer, Progressive, Picture. Ranks: Communicator, compose. Studies: compare.

Wrong arguments and broken files raise ValueError, devices OSError, inputs that are too large
MemoryError, each with the text that the program `delray` shows. Ctrl-C ends whatever runs. Other
threads of Python run meanwhile.
"""

from ._delray import __version__
from .delaunay import Delaunay, triangulate
from .dynamic import Dynamic
from .points import (
    PointFile,
    SimplifiedTerrain,
    Verdict,
    VoronoiDiagram,
    generate_points,
    hull,
    interpolate,
    methods,
    quality,
    read_mesh,
    read_points,
    simplify_terrain,
    verify,
    voronoi,
    write_mesh,
)

# What needs Embree, OpenImageIO and MPI comes when it is first asked for.
_LATER = {
    "Camera": "rendering",
    "Communicator": "rendering",
    "Picture": "rendering",
    "Progressive": "rendering",
    "Renderer": "rendering",
    "Scene": "rendering",
    "codecs": "rendering",
    "compare": "comparing",
    "compose": "rendering",
    "render": "rendering",
    "render_options": "rendering",
    "schemes": "rendering",
}

__all__ = [
    *_LATER,
    "Delaunay",
    "Dynamic",
    "PointFile",
    "SimplifiedTerrain",
    "Verdict",
    "VoronoiDiagram",
    "__version__",
    "generate_points",
    "hull",
    "interpolate",
    "methods",
    "quality",
    "read_mesh",
    "read_points",
    "simplify_terrain",
    "triangulate",
    "verify",
    "voronoi",
    "write_mesh",
]


def __getattr__(name: str) -> object:
    if name not in _LATER:
        raise AttributeError(f"module 'delray' has no attribute {name!r}")
    from importlib import import_module

    module = import_module("." + _LATER[name], __name__)
    globals()[name] = value = getattr(module, name)
    return value


def __dir__() -> list:
    return sorted(set(globals()) | set(_LATER))
