"""Functions of points, and of triangulations as arrays."""

from __future__ import annotations

import os
from typing import Any, Dict, List, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _delray
from .delaunay import Delaunay

PointsOrMesh = Union[ArrayLike, Delaunay]


def _mesh(points: PointsOrMesh, threads: Optional[int] = None) -> Any:
    delaunay = points if isinstance(points, Delaunay) else Delaunay(points, threads=threads)
    return delaunay._mesh


def interpolate(
    points: PointsOrMesh,
    values: ArrayLike,
    xi: ArrayLike,
    method: str = "linear",
    fill_value: float = np.nan,
    threads: Optional[int] = None,
) -> NDArray[np.float64]:
    """Values between points, as scipy.interpolate.griddata gives them.

    points : (n, 2) or (n, 3) array, or a Delaunay, which is then not made again.
    values : (n, ...): one or several for each point; of duplicates those of the lowest row count.
    xi : (..., ndim): where. The result is (...) with the axes of `values` after the first appended.
    method : "linear" over simplices, or "natural": by natural neighbours (Sibson 1981), smooth
        but at the points, and exact for linear functions.
    fill_value : outside of the convex hull.
    """
    if method not in ("linear", "natural"):
        raise ValueError(f"method: {method!r} is neither 'linear' nor 'natural'")
    mesh = _mesh(points, threads)
    values = np.asarray(values, np.float64)
    if values.ndim <= 1:
        return mesh.interpolate(values, xi, method == "natural", fill_value)
    xi = np.asarray(xi, np.float64)
    columns = values.reshape(values.shape[0], -1)
    results = [mesh.interpolate(c, xi, method == "natural", fill_value) for c in columns.T]
    return np.stack(results, axis=-1).reshape(xi.shape[:-1] + values.shape[1:])


class VoronoiDiagram(NamedTuple):
    """Vertices and edges of a Voronoi diagram. Vertex i is the circumcentre of simplex i."""

    #: (nsimplex, ndim) float64
    vertices: NDArray[np.float64]
    #: (m, 2) int32: vertices at the ends of the edges between neighbours
    edges: NDArray[np.int32]
    #: (h,) int32: vertices where the edges to infinity begin, one per facet of the hull
    ray_starts: NDArray[np.int32]
    #: (h, ndim) float64: their directions, of length 1
    ray_directions: NDArray[np.float64]
    #: (npoints + 1,) int32: the vertices of the cell of row i are cells[cell_begin[i]:cell_begin[i + 1]],
    #: in 2D counterclockwise
    cell_begin: NDArray[np.int32]
    cells: NDArray[np.int32]

    def cell(self, row: int) -> NDArray[np.int32]:
        """The vertices of the cell of a row; none for duplicates."""
        return self.cells[self.cell_begin[row] : self.cell_begin[row + 1]]


def voronoi(points: PointsOrMesh, threads: Optional[int] = None) -> VoronoiDiagram:
    """The Voronoi diagram of (n, 2) or (n, 3) points, or of a Delaunay's. Centres are computed in
    float64: those of almost flat simplices are inexact."""
    return VoronoiDiagram(**_mesh(points, threads).voronoi())


def hull(points: PointsOrMesh, threads: Optional[int] = None) -> NDArray[np.int32]:
    """Rows of the points on the convex hull, those within its edges and faces included: in 2D
    counterclockwise from the lowest row, in 3D ascending. None where there are no simplices."""
    return _mesh(points, threads).hull_vertices()


def quality(points: PointsOrMesh, threads: Optional[int] = None) -> Dict[str, Any]:
    """How well the simplices are shaped: simplices (their number), min_angle, max_angle,
    mean_min_angle (degrees; in 3D dihedral), min_radius_ratio, mean_radius_ratio (1: regular, 0:
    flat), angles (18 counts of all angles by tens of degrees), radius_ratios (10 counts by
    tenths)."""
    result = _mesh(points, threads).quality()
    result["angles"] = np.array(result["angles"], np.int64)
    result["radius_ratios"] = np.array(result["radius_ratios"], np.int64)
    return result


class Verdict(NamedTuple):
    """What `verify` found. True where the simplices are `delaunay`."""

    #: the simplices cover the convex hull exactly once and use every distinct point
    valid: bool
    #: and no circumscribed sphere has a point inside
    delaunay: bool
    #: and they are those that Delaunay() gives
    canonical: bool
    #: the first simplex that breaks the first of these that fails
    simplex: Optional[int]
    #: one sentence about that
    reason: str
    #: number of distinct points
    distinct: int

    def __bool__(self) -> bool:
        return self.delaunay


def verify(
    points: PointsOrMesh,
    simplices: Optional[ArrayLike] = None,
    *,
    dim: Optional[int] = None,
    threads: Optional[int] = None,
) -> Verdict:
    """Checks a triangulation exactly, whoever made it.

    points : (n, 2) or (n, 3), or a Delaunay, whose simplices are then the default.
    simplices : (m, dim + 1) rows of points, positively oriented.
    dim : 2 checks triangles over x and y of three columns.
    """
    if isinstance(points, Delaunay):
        dim = points.ndim if dim is None else dim
        simplices = points.simplices if simplices is None else simplices
        points = points.points
    if simplices is None:
        raise ValueError("simplices: missing")
    return Verdict(**_delray.verify(points, simplices, dim, threads))


class SimplifiedTerrain(NamedTuple):
    """The points that were kept, and their triangulation."""

    #: (k,) int32 rows, ascending
    kept: NDArray[np.int32]
    #: (m, 3) int32 rows of all points
    simplices: NDArray[np.int32]
    #: the greatest distance, in z, of a point that was not kept
    largest_error: float


def simplify_terrain(points: ArrayLike, max_error: float) -> SimplifiedTerrain:
    """Keeps as many of (n, 3) points as a surface over x and y needs to pass each of the others
    within `max_error`, in z and in the unit of z; 0 leaves out those alone that lie on it."""
    return SimplifiedTerrain(*_delray.simplify_terrain(points, max_error))


class PointFile(NamedTuple):
    """Points of a file; what it does not have is None. Row i of everything belongs together."""

    #: (n, 2) or (n, 3) float64
    points: NDArray[np.float64]
    #: (n, 4) uint8: sRGB and alpha
    colors: Optional[NDArray[np.uint8]]
    #: (n,) float32, 0 .. 1
    intensity: Optional[NDArray[np.float32]]
    #: (n,) uint8: classes of LAS
    classification: Optional[NDArray[np.uint8]]
    #: (n,) uint8, of LAS: number of the return | number of returns << 4
    returns: Optional[NDArray[np.uint8]]
    #: what the file has and this has not
    warnings: List[str]
    #: (m, 3) or (m, 4) int32, of read_mesh
    simplices: Optional[NDArray[np.int32]] = None


def read_points(path: Union[str, os.PathLike]) -> PointFile:
    """Reads points from XYZ, CSV, PLY, OBJ, OFF, PCD, LAS, LAZ, JSON, .node or an elevation image."""
    return PointFile(**_delray.read_points(os.fspath(path)))


def read_mesh(path: Union[str, os.PathLike]) -> PointFile:
    """Reads points and simplices from PLY, OBJ, OFF, STL, VTU, .node with .ele, or a folder of
    pieces. Nothing is repaired."""
    return PointFile(**_delray.read_mesh(os.fspath(path)))


def write_mesh(
    path: Union[str, os.PathLike], points: PointsOrMesh, simplices: Optional[ArrayLike] = None
) -> None:
    """Writes (n, 2) or (n, 3) points with (m, 3) or (m, 4) simplices, or a Delaunay, in the format
    that the suffix names: .ply .obj .off .stl .vtu .node. The file appears whole or not at all."""
    if isinstance(points, Delaunay):
        simplices = points.simplices if simplices is None else simplices
        points = points.points
    if simplices is None:
        raise ValueError("simplices: missing")
    _delray.write_mesh(os.fspath(path), points, simplices)


def generate_points(kind: str, n: int, dim: int = 2, seed: int = 1) -> NDArray[np.float64]:
    """(n, dim) points: uniform, gauss, cluster, grid, arc, sphere ...; the same on every machine."""
    return _delray.generate_points(kind, n, dim, seed)


def methods() -> Dict[str, str]:
    """Names of methods of triangulation, and what they do."""
    return _delray.methods()
