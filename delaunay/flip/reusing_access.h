// The access policy of a flip kernel that is alone with a mesh in space.
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <new>
#include <vector>

#include "delaunay/flip/dag_access.h"
#include "delaunay/mesh/flip_counter.h"
#include "delaunay/mesh/mesh.h"

namespace delray::delaunay::internal {

// Grants everything, uses the slots of retired tetrahedra again and lets the mesh grow.
class ReusingAccess : public FlipCounter {
 public:
  static constexpr bool kMayRetry = false;

  // Slots from `used` on are free.
  ReusingAccess(Mesh<3>& mesh, SimplexNumber used) : mesh_(mesh), used_(used), last_(0) {}

  Grant acquire(std::initializer_list<SimplexNumber>) const { return Grant::kGranted; }
  void reserve(SimplexNumber) const {}
  SimplexNumber create(const std::array<VertexNumber, 4>& vertices) {
    if (free_.empty()) {
      if (used_ == mesh_.size()) grow();
      last_ = used_++;
    } else {
      last_ = free_.back();
      free_.pop_back();
    }
    for (unsigned k = 0; k < 4; ++k) mesh_.set_vertex(corner_of(last_, k), vertices[k]);
    return last_;
  }
  void link(CornerNumber outside, CornerNumber inside) { mesh_.link(outside, inside); }
  void retire(SimplexNumber simplex, const std::array<SimplexNumber, 4>&) {
    mesh_.set_vertex(corner_of(simplex, 0), kDeadVertex);
    free_.push_back(simplex);
  }

  SimplexNumber used() const { return used_; }
  // The simplex created last, which is alive between insertions.
  SimplexNumber last() const { return last_; }

 private:
  void grow() {
    const std::size_t size = std::min(mesh_.size() + mesh_.size() / 2, kMaximumSimplices);
    if (size == mesh_.size()) throw std::bad_alloc();
    mesh_.grow(size);
  }

  Mesh<3>& mesh_;
  SimplexNumber used_, last_;
  std::vector<SimplexNumber> free_;
};

}  // namespace delray::delaunay::internal
