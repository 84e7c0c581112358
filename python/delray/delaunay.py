"""Delaunay triangulations with the attributes and methods of scipy.spatial.Delaunay."""

from __future__ import annotations

import warnings
from functools import cached_property
from typing import Any, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _delray


class Delaunay:
    """The Delaunay triangulation of points of the plane or of space.

    Names, shapes and types are those of `scipy.spatial.Delaunay`. Other than there

    - the result is exact for all finite points, lattices and duplicates among them, and the same
      for every method and number of threads;
    - points that are all equal, on one line or (3D) on one plane are no error: they have no
      simplices;
    - `find_simplex` is exact and includes boundaries; there is no tolerance.

    Parameters
    ----------
    points : (n, 2) or (n, 3) array
        Coordinates in any unit. An array of float64 whose rows are contiguous is used where it is,
        at any distance between rows, and must not change while the triangulation is in use; every
        other one is copied.
    furthest_site : bool
        Not supported: True raises ValueError.
    incremental : bool
        Whether `add_points` will be called. See `Dynamic` for points that come one by one and go.
    qhull_options : str
        Without effect, and warned of.
    threads : int
        Threads to use, here and in the methods; all cores by default.
    dim : 2 or 3
        Dimension; by default the number of columns. 2 with three columns triangulates a terrain by
        its x and y.
    method, location, split, order, deadlocks, locks, unlock, searching, queue, seed, statistics
        See `triangulate`.
    """

    furthest_site = False
    good = None
    #: Heights of the paraboloid that `equations` are about: those of `lift_points`.
    paraboloid_scale = 1.0
    paraboloid_shift = 0.0

    def __init__(
        self,
        points: ArrayLike,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: Optional[str] = None,
        *,
        dim: Optional[int] = None,
        threads: Optional[int] = None,
        **method: Any,
    ) -> None:
        if furthest_site:
            raise ValueError("furthest_site: there is no furthest-site triangulation")
        if qhull_options is not None:
            warnings.warn("qhull_options has no effect: this is not Qhull", stacklevel=2)
        self._options = dict(method, dim=dim, threads=threads)
        self._incremental = incremental
        self._set(points)

    def _set(self, points: ArrayLike) -> None:
        made = _delray.Triangulation(points, **self._options)
        for name in _CACHED:
            self.__dict__.pop(name, None)
        self._mesh = made

    # What there is.

    @property
    def points(self) -> NDArray[np.float64]:
        """(n, columns) float64: the points, read-only."""
        return self._mesh.points

    @property
    def ndim(self) -> int:
        """2 or 3."""
        return self._mesh.dim

    @property
    def npoints(self) -> int:
        """Number of points, duplicates included."""
        return self._mesh.points.shape[0]

    @property
    def nsimplex(self) -> int:
        """Number of simplices."""
        return self._mesh.simplices.shape[0]

    @property
    def min_bound(self) -> NDArray[np.float64]:
        """(ndim,): the least coordinates."""
        return self._coordinates.min(axis=0)

    @property
    def max_bound(self) -> NDArray[np.float64]:
        """(ndim,): the greatest coordinates."""
        return self._coordinates.max(axis=0)

    @cached_property
    def simplices(self) -> NDArray[np.int32]:
        """(nsimplex, ndim + 1) int32: the rows of points at the corners, in 2D counterclockwise, in
        3D positively oriented. Of equal points the lowest row. Read-only, without copy."""
        return self._mesh.simplices

    @property
    def vertices(self) -> NDArray[np.int32]:
        """Another name of `simplices`."""
        return self.simplices

    @cached_property
    def neighbors(self) -> NDArray[np.int32]:
        """(nsimplex, ndim + 1) int32: the simplex opposite to corner k, -1 beyond the hull."""
        return self._mesh.neighbors

    @cached_property
    def convex_hull(self) -> NDArray[np.int32]:
        """(nfacets, ndim) int32: the edges or triangles of the hull, counterclockwise as seen from
        outside in 3D, along the hull in 2D."""
        return self._mesh.hull_facets()

    @cached_property
    def vertex_to_simplex(self) -> NDArray[np.int32]:
        """(npoints,) int32: a simplex that has the point as a corner: of a duplicate that of the
        row which represents it; -1 where there are no simplices."""
        at = self._mesh.simplex_at
        if self.coplanar.shape[0] == 0:
            return at
        at = at.copy()
        at[self.coplanar[:, 0]] = at[self.coplanar[:, 2]]
        return at

    @cached_property
    def vertex_neighbor_vertices(self) -> Tuple[NDArray[np.int32], NDArray[np.int32]]:
        """(indptr, indices): the neighbours of row k are indices[indptr[k]:indptr[k + 1]]."""
        return self._mesh.vertex_neighbours()

    @cached_property
    def coplanar(self) -> NDArray[np.int32]:
        """(m, 3) int32: rows that are no corner, a simplex at each, and the row at the same place.
        These are duplicates and nothing else: no point is left out for precision."""
        if self.nsimplex == 0:
            return np.empty((0, 3), np.int32)
        rows = np.flatnonzero(self._mesh.simplex_at < 0).astype(np.int32)
        nearest = self._mesh.nearest(self._coordinates[rows])
        return np.column_stack((rows, self._mesh.simplex_at[nearest], nearest))

    @cached_property
    def transform(self) -> NDArray[np.float64]:
        """(nsimplex, ndim + 1, ndim) float64: barycentric coordinates of x in simplex i are
        c = transform[i, :ndim] @ (x - transform[i, ndim]) and 1 - c.sum(). NaN for simplices that
        are flat in float64."""
        corners = self._coordinates[self.simplices]
        last = corners[:, -1]
        edges = (corners[:, :-1] - last[:, None]).transpose(0, 2, 1)
        result = np.full((self.nsimplex, self.ndim + 1, self.ndim), np.nan)
        with np.errstate(all="ignore"):
            determinant = np.linalg.det(edges)
        fine = np.isfinite(determinant) & (determinant != 0)
        result[fine, : self.ndim] = np.linalg.inv(edges[fine])
        result[:, self.ndim] = last
        return result

    @cached_property
    def equations(self) -> NDArray[np.float64]:
        """(nsimplex, ndim + 2) float64: unit normals (pointing down) and offsets of the simplices
        that are lifted to the paraboloid, see `lift_points`."""
        lifted = self.lift_points(self._coordinates[self.simplices])
        edges = lifted[:, :-1] - lifted[:, -1:]
        gradient = np.full((self.nsimplex, self.ndim), np.nan)
        with np.errstate(all="ignore"):
            determinant = np.linalg.det(edges[:, :, :-1])
        fine = np.isfinite(determinant) & (determinant != 0)
        gradient[fine] = np.linalg.solve(edges[fine, :, :-1], edges[fine, :, -1])
        normal = np.column_stack((gradient, np.full(self.nsimplex, -1.0)))
        normal /= np.sqrt((normal**2).sum(axis=1, keepdims=True))
        return np.column_stack((normal, -(normal * lifted[:, -1]).sum(axis=1)))

    @property
    def hash(self) -> str:
        """The identity of the set of simplices, as `delray triangulate --stats` has it."""
        return self._mesh.hash

    @property
    def statistics(self) -> Optional[dict]:
        """Seconds of phases and counts of locks, summed over threads, with statistics=True."""
        return self._mesh.statistics

    # What is asked.

    def find_simplex(
        self, xi: ArrayLike, bruteforce: bool = False, tol: Optional[float] = None
    ) -> NDArray[np.int32]:
        """The simplices that contain the points of `xi`, boundaries included; -1 outside.

        xi : (..., ndim); the result is (...) int32. Exact, so that `bruteforce` gives the same, and
        `tol` has no effect, which is warned of.
        """
        if tol is not None:
            warnings.warn("tol has no effect: points are located exactly", stacklevel=2)
        return self._mesh.locate(xi)

    def nearest(self, xi: ArrayLike) -> NDArray[np.int32]:
        """The rows of the corners nearest to `xi` (..., ndim); -1 where there are no points."""
        return self._mesh.nearest(xi)

    def lift_points(self, x: ArrayLike) -> NDArray[np.float64]:
        """`x` (..., ndim) with its squared distance from the origin as one more coordinate."""
        x = np.asarray(x, np.float64)
        height = (x**2).sum(axis=-1, keepdims=True)
        return np.concatenate((x, height), axis=-1)

    def plane_distance(self, xi: ArrayLike) -> NDArray[np.float64]:
        """(..., nsimplex): distances of the lifted `xi` (..., ndim) from the planes of
        `equations`."""
        lifted = self.lift_points(xi)
        return lifted @ self.equations[:, :-1].T + self.equations[:, -1]

    # Points that come.

    def add_points(self, points: ArrayLike, restart: bool = False) -> None:
        """Adds points, whose rows follow; needs incremental=True. Triangulates all anew, which is
        the same triangulation: `Dynamic` inserts. `restart` makes no difference."""
        if not self._incremental:
            raise RuntimeError("add_points: needs incremental=True, and none after close()")
        self._set(np.concatenate((self.points, np.asarray(points, np.float64))))

    def close(self) -> None:
        """Ends adding points."""
        self._incremental = False

    @property
    def _coordinates(self) -> NDArray[np.float64]:
        return self.points[:, : self.ndim]

    def __repr__(self) -> str:
        return f"<delray.Delaunay: {self.npoints} points, {self.nsimplex} simplices, {self.ndim}D>"


_CACHED = [name for name, value in vars(Delaunay).items() if isinstance(value, cached_property)]


def triangulate(
    points: ArrayLike,
    *,
    dim: Optional[int] = None,
    method: str = "auto",
    location: str = "auto",
    split: str = "auto",
    order: str = "auto",
    deadlocks: str = "auto",
    locks: str = "auto",
    unlock: str = "auto",
    searching: int = 0,
    queue: int = 0,
    seed: int = 1,
    threads: Optional[int] = None,
    statistics: bool = False,
) -> Delaunay:
    """Triangulates by one of the methods that `methods()` describes; the result is the same for
    all. Names that do not go together raise ValueError, which lists those that do.

    dim : 2 or 3, by default the number of columns; 2 takes x and y of three.
    method, location, split, order, deadlocks, locks, unlock : names, as `delray triangulate
        --list` explains them.
    searching : threads of the batch method that locate points; 0: by measured times.
    queue : places in the queue of the batch method; 0: as many as in its paper.
    seed : of everything that is random.
    threads : all cores by default.
    statistics : whether to count, and to time every phase, which takes time itself.
    """
    return Delaunay(
        points,
        dim=dim,
        method=method,
        location=location,
        split=split,
        order=order,
        deadlocks=deadlocks,
        locks=locks,
        unlock=unlock,
        searching=searching,
        queue=queue,
        seed=seed,
        threads=threads,
        statistics=statistics,
    )
