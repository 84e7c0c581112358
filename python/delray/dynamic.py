"""Triangulations whose points come and go."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _delray


class Dynamic:
    """A Delaunay triangulation of the plane (dim 2) or of space (3) that changes.

    Inserted points get rows 0, 1, 2 ..., which are not used again. At any moment `simplices` are
    those of `Delaunay` over the live points. Inserting a point takes expected O(n^(1/3)), near the
    one before O(1).
    """

    def __init__(self, dim: int = 2) -> None:
        if dim not in (2, 3):
            raise ValueError(f"dim: {dim} is neither 2 nor 3")
        self.dim = dim
        self._points = _delray.Dynamic2() if dim == 2 else _delray.Dynamic3()

    def insert(self, points: ArrayLike) -> NDArray[np.int32]:
        """Inserts (n, dim) points, or one (dim,), and returns their rows (n,) int32. Nothing is
        inserted where a coordinate is not finite (ValueError)."""
        points = np.asarray(points, np.float64)
        return self._points.insert(points[None] if points.ndim == 1 else points)

    def remove(self, rows: ArrayLike) -> int:
        """Removes the points of rows, and returns how many of these were live."""
        return self._points.remove(np.asarray(rows, np.int64))

    def is_live(self, row: int) -> bool:
        """Whether a row was inserted and not removed."""
        return self._points.is_live(row)

    @property
    def simplices(self) -> NDArray[np.int32]:
        """(m, dim + 1) int32 rows, positively oriented; of equal points the lowest live one. Made
        anew by every use, in O(m)."""
        return self._points.simplices()

    def __len__(self) -> int:
        """Number of live rows."""
        return len(self._points)

    def __repr__(self) -> str:
        return f"<delray.Dynamic: {len(self)} points, {self.dim}D>"
