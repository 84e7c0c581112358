// Start and end of a run on a history, alike for all methods that work on one.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "delaunay/flip/dag.h"
#include "delaunay/flip/dag_flip_2d.h"
#include "delaunay/flip/dag_flip_3d.h"
#include "delaunay/insertion/plan.h"
#include "delaunay/insertion/point_supply.h"
#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Points in the order of a plan, and a history of the first simplex and the ghosts around it.
template <int D>
class DagRun {
 public:
  using Point = glm::vec<D, double, glm::defaultp>;

  // Errors: see triangulate().
  DagRun(PointView<double> input, const Options& options, std::size_t parts);

  // Whether all points are equal or collinear or, in space, coplanar: then there is nothing to
  // insert.
  bool is_flat() const { return !first_; }
  std::size_t parts() const { return begins_.size() - 1; }
  std::size_t begin(std::size_t part) const { return begins_[part]; }
  std::size_t end(std::size_t part) const { return begins_[part + 1]; }
  // Every part for the thread of its number.
  PointSupply supply() const {
    PointSupply supply(parts());
    for (std::size_t part = 0; part < parts(); ++part) supply.set(part, begin(part), end(part));
    return supply;
  }
  const Point& point(VertexNumber vertex) const { return points_[vertex]; }
  // Whether a point is a vertex of the first simplex.
  bool is_first(VertexNumber vertex) const {
    for (const VertexNumber first : *first_) {
      if (vertex == first) return true;
    }
    return false;
  }
  // REQUIRES: not flat.
  DagTriangulation<D> triangulation() { return {dag_, points_, Orientation<D>(points_, *first_)}; }

  // The vertex of a leaf that has the coordinates of a point, or kInfiniteVertex.
  VertexNumber equal_vertex(NodeNumber leaf, const Point& q) const {
    for (unsigned k = 0; k <= D; ++k) {
      const VertexNumber vertex = dag_.vertex(corner_of(leaf, k));
      if (vertex != kInfiniteVertex && points_[vertex] == q) return vertex;
    }
    return kInfiniteVertex;
  }
  // Notes that a point is equal to a vertex. Any thread.
  void merge(VertexNumber vertex, VertexNumber point);

  // The finite leaves, who made them, and the statistics, completed. O(nodes).
  Result finish();

  const Options& options;
  Statistics statistics;  // so far; one thread at a time

 private:
  void start_dag();
  Result leaves() const;

  // Three by the subdivision and two by each of three flips on average (Kohout 2004, 6.2: 6 to 10);
  // in space 54 were counted.
  static constexpr std::size_t kNodesPerPoint = D == 2 ? 10 : 56;
  // In space some 6.8 and a few that threads keep for later.
  static constexpr std::size_t kLeavesPerPoint = D == 2 ? 3 : 8;

  std::vector<Point> points_;
  std::vector<std::uint32_t> rows_;  // point i was row rows_[i], the lowest of equal ones
  std::vector<std::size_t> begins_;
  std::optional<std::array<VertexNumber, D + 1>> first_;
  std::atomic<std::uint64_t> duplicates_ = 0;
  Dag<D> dag_;
};

}  // namespace delray::delaunay::internal
