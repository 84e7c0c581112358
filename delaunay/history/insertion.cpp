// Sequential incremental insertion with flips (Kohout 2004, sections 6 and 8), in the plane and in
// space.
//
// A point's simplex is found by a walk from the last one, by a hierarchy of coarser triangulations
// (Devillers 1998; 2D) or by descent through the history; it is subdivided, and flips restore the
// Delaunay property. One template serves the two ways that keep no history, another the history.
// Expected O(n log n) in random or brio order; along a curve alone some inputs make it quadratic.
//
// Degenerate: collinear (3D: coplanar) points have no first simplex, and the result none. A point
// equal to a vertex only lowers its row.
#include "delaunay/history/insertion.h"

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/flip/flip_2d.h"
#include "delaunay/flip/flip_3d.h"
#include "delaunay/flip/hierarchy.h"
#include "delaunay/flip/reusing_access.h"
#include "delaunay/history/dag_location.h"
#include "delaunay/history/dag_run.h"
#include "delaunay/history/insert_in_leaf.h"
#include "delaunay/history/sole_dag_access.h"
#include "delaunay/insertion/insert_walking.h"
#include "delaunay/insertion/insertion_phases.h"
#include "delaunay/insertion/walk.h"
#include "delaunay/mesh/access.h"
#include "delaunay/mesh/add_counts.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/start_mesh.h"
#include "delaunay/mesh/stopwatch.h"

namespace delray::delaunay::internal {
namespace {

// A mesh to walk through.
template <int D>
class WalkedMesh;

template <>
class WalkedMesh<2> {
 public:
  WalkedMesh(std::span<const glm::dvec2> points, const std::array<VertexNumber, 3>& first,
             std::uint64_t seed)
      : points_(points),
        mesh_(2 * points.size() - 2),
        random_(static_cast<std::uint32_t>(seed) | 1) {
    start_mesh(mesh_, first);
  }

  Place locate(VertexNumber vertex) {
    const Place place = walk(mesh_, points_, last_, points_[vertex], random_);
    last_ = place.simplex;
    return place;
  }
  void subdivide(VertexNumber vertex, SimplexNumber simplex) {
    internal::subdivide(mesh_, simplex, vertex, access_, suspects_);
  }
  void legalize() { internal::legalize(mesh_, points_, access_, suspects_); }
  const FlipCounts& flips() const { return access_.flips(); }
  Mesh<2> take() {
    mesh_.shrink(access_.used());
    return std::move(mesh_);
  }

 private:
  std::span<const glm::dvec2> points_;
  Mesh<2> mesh_;
  SoleAccess access_{4};
  std::vector<CornerNumber> suspects_;
  SimplexNumber last_ = 0;
  std::uint32_t random_;
};

template <>
class WalkedMesh<3> {
 public:
  WalkedMesh(std::span<const glm::dvec3> points, const std::array<VertexNumber, 4>& first,
             std::uint64_t seed)
      : orientation_(points, first),
        mesh_(kSlotsPerPoint * points.size()),
        random_(static_cast<std::uint32_t>(seed) | 1) {
    start_mesh(mesh_, first);
  }

  Place locate(VertexNumber vertex) {
    return walk(mesh_, orientation_, access_.last(), orientation_.point(vertex), random_);
  }
  void subdivide(VertexNumber vertex, SimplexNumber simplex) { flips_.subdivide(simplex, vertex); }
  void legalize() { flips_.legalize(); }
  const FlipCounts& flips() const { return access_.flips(); }
  Mesh<3> take() {
    mesh_.shrink(access_.used());
    return std::move(mesh_);
  }

 private:
  // Evenly spread points have hardly as many tetrahedra.
  static constexpr std::size_t kSlotsPerPoint = 7;

  Orientation<3> orientation_;
  Mesh<3> mesh_;
  ReusingAccess access_{mesh_, 5};
  std::vector<CornerNumber> suspects_;
  Flips3d<Mesh<3>, ReusingAccess> flips_{mesh_, orientation_, access_, suspects_};
  std::uint32_t random_;
};

// Down the history of the triangulation to the simplex of the next point.
template <int D>
Result insert_descending(PointView<double> input, const Options& options) {
  DagRun<D> run(input, options, 1);
  if (!run.is_flat()) {
    const DagTriangulation<D> triangulation = run.triangulation();
    SoleDagAccess<D> access(triangulation.dag, 0);
    InsertionPhases phases(options, run.statistics);
    std::vector<NodeNumber> suspects;
    for (VertexNumber vertex = 0; vertex < run.end(0); ++vertex) {
      insert_from_root(run, triangulation, vertex, access, suspects, phases);
    }
    phases.finish();
    if (options.statistics) add(run.statistics.flips, access.flips());
  }
  return run.finish();
}

}  // namespace

Result insert_all(PointView<double> points, const Options& options) {
  const auto insert = [&]<int D>() {
    if (options.location == "dag") return insert_descending<D>(points, options);
    if constexpr (D == 2) {
      if (options.location == "hierarchy") return insert_walking<2, Hierarchy>(points, options);
    }
    return insert_walking<D, WalkedMesh<D>>(points, options);
  };
  return options.dim == 2 ? insert.template operator()<2>() : insert.template operator()<3>();
}

}  // namespace delray::delaunay::internal
