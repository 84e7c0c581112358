// Triangulations, convex hulls and files of points with up to six coordinates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "delaunay/points.h"
#include "delaunay/triangulation.h"
#include "delaunay/verify.h"
#include "files/memory_budget.h"
#include "parallel/progress.h"

namespace delray::delaunay {

inline constexpr int kMostDimensions = 6;

// The triangulation by the rule of predicates/conflict.h, of points with `dim` coordinates each,
// dim from 2 to kMostDimensions; of equal points the lowest row represents, -0 equals 0. In 2D and
// 3D the simplices are those of triangulate(), which is faster. No simplices if the points do not
// span the space.
//
// Cavities (Bowyer 1981, Watson 1981), one thread; exact determinants of any dimension decide where
// doubles do not. O(n^ceil(dim / 2)) at worst, which points on a curve reach; of uniform points the
// simplices of a vertex are 6, 27, 150, 10^3 and 8 * 10^3 for 2 to 6 dimensions. `seed` decides
// about the order of insertion.
//
// Errors: std::invalid_argument for a dimension, a coordinate that is not finite (names the row) or
// more than 2^28 simplices; parallel::Interrupted by `progress`, which is advanced by the number of
// points, not started.
Triangulation triangulate_dimensions(PointView<double> points, int dim, std::uint64_t seed = 1,
                                     parallel::Progress* progress = nullptr);

// What verify_simplices() says, of simplices with dim + 1 vertices each and points with `dim`
// coordinates; exact, and of nothing that triangulates but the determinants. O(n log n), one
// thread.
//
// Errors: std::invalid_argument for a dimension, vertices that do not make whole simplices or a
// coordinate that is not finite.
Verdict verify_dimensions(PointView<double> points, int dim,
                          std::span<const std::uint32_t> simplices);

// A row and how far its point is.
struct NearRow {
  std::uint32_t row = 0;
  double distance = 0;
};

// The `count` other rows nearest to a row, or all that there are, the nearest first. The Delaunay
// triangulation of the points finds them: the next nearest is a neighbour of one before it. One
// without simplices, of points that do not span the space, has all compared. Distances in floating
// point. O(simplices + neighbours met).
//
// Throws std::invalid_argument for rows that are not there.
std::vector<NearRow> nearest_rows(PointView<double> points, const Triangulation& triangulation,
                                  std::uint32_t of, std::size_t count);

// The facets of a hull.
struct ConvexHull {
  int dim = 2;
  // `dim` vertices each, rows of the input, of equal points the lowest. In 2D edges
  // counterclockwise; in 3D triangles counterclockwise as seen from outside; in 4D tetrahedra
  // t0, t1, t2, t3 for which det(t1 - t0, t2 - t0, t3 - t0, q - t0) > 0 of points q beyond.
  std::vector<std::uint32_t> facets;
  std::uint64_t distinct = 0;  // points of the input

  std::size_t size() const { return facets.size() / static_cast<std::size_t>(dim); }
};

// The hull by quickhull (Barber, Dobkin and Huhdanpaa 1996), exact on every input. Every point on
// the hull is a vertex, and sides that are flat are cut into the simplices of their Delaunay
// triangulation by the rule of predicates/conflict.h: the facets are those that the Delaunay
// triangulation of the points ends at, whatever the order of the points. No facets if the points do
// not span the space.
//
// Expected O(n log n) in 2D and 3D; in 4D the hull itself may have n^2 facets.
//
// Errors: std::invalid_argument for a dimension that is not 2 to 4, a view of too few coordinates,
// a coordinate that is not finite (names the row).
ConvexHull convex_hull(PointView<double> points, int dim);

// Points with `dim` coordinates each, one point after the other.
struct PointTable {
  int dim = 0;
  std::vector<double> coordinates;

  std::size_t size() const {
    return dim == 0 ? 0 : coordinates.size() / static_cast<std::size_t>(dim);
  }
  // The table must outlive it.
  PointView<double> view() const {
    return {reinterpret_cast<const std::byte*>(coordinates.data()), size(),
            static_cast<std::size_t>(dim) * sizeof(double)};
  }
};

// Points and simplices as a pair of files has them; `distinct` and `hull_facets` stay 0.
struct TableMesh {
  PointTable points;
  Triangulation triangulation;
};

// "n dimension attributes markers", then rows "number coordinates ..."; attributes and markers are
// left out. The dimension is from 2 to kMostDimensions. O(bytes), parallel.
//
// Throws FileError (input) that names the line of what is broken, FileError (memory).
PointTable read_point_table(const std::filesystem::path& path,
                            const files::MemoryBudget& memory = {});

// Reads X.node and X.ele, whichever of them `path` names. Simplices have dim + 1 corners.
TableMesh read_table_mesh(const std::filesystem::path& path,
                          const files::MemoryBudget& memory = {});

// Writes X.node and X.ele, whichever of them `path` names, numbered from 0; coordinates read back
// equal. Both appear whole or not at all. Throws FileError (device). REQUIRES: vertices are rows.
void write_table_mesh(const std::filesystem::path& path, const PointTable& points,
                      const Triangulation& triangulation);

}  // namespace delray::delaunay
