// The triangles in conflict with a point are connected: those over the edges of its own triangle,
// and so on. They are visited around the hole, so that its border comes out as a cycle and new
// triangles are linked as they are made. A hole of k triangles becomes k + 2.
//
// Degenerate: ghosts make holes that reach out of the hull like all others; ties are decided by the
// perturbation of conflict.h.
#include "delaunay/construction/bowyer_watson.h"

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/insertion/insert_walking.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/start_mesh.h"
#include "delaunay/predicates/conflict.h"

namespace delray::delaunay::internal {
namespace {

class HoledMesh {
 public:
  HoledMesh(std::span<const glm::dvec2> points, const std::array<VertexNumber, 3>& first,
            std::uint64_t seed)
      : points_(points),
        mesh_(2 * points.size() - 2),
        random_(static_cast<std::uint32_t>(seed) | 1) {
    start_mesh(mesh_, first);
  }

  Place locate(VertexNumber vertex) {
    return walk(mesh_, points_, last_, points_[vertex], random_);
  }

  // The whole insertion: nothing is left to legalize.
  void subdivide(VertexNumber vertex, SimplexNumber simplex) {
    free_.assign({simplex});
    border_.clear();
    for (unsigned k = 0; k < 3; ++k) {
      dig(vertex, mesh_.neighbour(corner_of(simplex, (k + 2) % 3)));
    }
    fill(vertex);
  }
  void legalize() {}

  Mesh<2> take() {
    mesh_.shrink(used_);
    return std::move(mesh_);
  }

 private:
  struct BorderEdge {
    VertexNumber start, end;  // the hole to its left
    CornerNumber outside;
  };

  // Comes into the triangle of a corner over the edge opposite to it, counterclockwise around the
  // hole.
  void dig(VertexNumber vertex, CornerNumber entry) {
    pending_.assign({entry});
    while (!pending_.empty()) {
      const CornerNumber corner = pending_.back();
      pending_.pop_back();
      const CornerNumber next = next_corner(corner), previous = previous_corner(corner);
      if (!conflict(mesh_, points_, simplex_of(corner), points_[vertex])) {
        border_.push_back({mesh_.vertex(previous), mesh_.vertex(next), corner});
        continue;
      }
      free_.push_back(simplex_of(corner));
      pending_.push_back(mesh_.neighbour(previous));
      pending_.push_back(mesh_.neighbour(next));
    }
  }

  void fill(VertexNumber vertex) {
    while (free_.size() < border_.size()) free_.push_back(used_++);
    for (std::size_t i = 0; i < border_.size(); ++i) {
      const SimplexNumber t = free_[i];
      mesh_.set_vertex(corner_of(t, 0), border_[i].start);
      mesh_.set_vertex(corner_of(t, 1), border_[i].end);
      mesh_.set_vertex(corner_of(t, 2), vertex);
      mesh_.link(corner_of(t, 2), border_[i].outside);
      if (i > 0) mesh_.link(corner_of(t, 1), corner_of(free_[i - 1], 0));
    }
    mesh_.link(corner_of(free_.front(), 1), corner_of(free_[border_.size() - 1], 0));
    last_ = free_.front();
  }

  std::span<const glm::dvec2> points_;
  Mesh<2> mesh_;
  SimplexNumber used_ = 4, last_ = 0;
  std::uint32_t random_;
  std::vector<SimplexNumber> free_;  // the hole's, then new ones
  std::vector<BorderEdge> border_;   // each starts where the one before it ends
  std::vector<CornerNumber> pending_;
};

}  // namespace

Result insert_by_holes(PointView<double> points, const Options& options) {
  return insert_walking<2, HoledMesh>(points, options);
}

}  // namespace delray::delaunay::internal
