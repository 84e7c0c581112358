// A cavity kernel that inserts vertices one after the other and counts them.
#pragma once

#include <cstdint>

#include "delaunay/cavity/cavity.h"
#include "delaunay/mesh/stopwatch.h"
#include "delaunay/triangulate.h"
#include "parallel/progress.h"

namespace delray::delaunay::internal {

template <class Region>
class CavityInserter {
 public:
  CavityInserter(Mesh<3>& mesh, SpaceVertex* vertices, const SphereTests& tests, SlotPool& pool,
                 parallel::Progress* progress, bool timed)
      : kernel_(mesh, vertices, tests, pool), progress_(progress), timed_(timed) {}

  Cavity<Region>& kernel() { return kernel_; }
  std::uint64_t inserted() const { return inserted_; }
  double locate_seconds() const { return locate_seconds_; }
  double subdivide_seconds() const { return subdivide_seconds_; }

  Insertion insert(VertexNumber vertex) {
    if (timed_) watch_.lap();
    SimplexNumber place = 0;
    Insertion result = kernel_.locate(vertex, place);
    if (timed_) locate_seconds_ += watch_.lap();
    if (result == Insertion::kDone) {
      result = kernel_.insert(vertex, place);
      if (timed_) subdivide_seconds_ += watch_.lap();
      if (result == Insertion::kDone) ++inserted_;
    }
    if (progress_ != nullptr && (result == Insertion::kDone || result == Insertion::kEqual)) {
      progress_->advance();
    }
    return result;
  }

 private:
  Cavity<Region> kernel_;
  parallel::Progress* progress_;
  bool timed_;
  Stopwatch watch_;
  std::uint64_t inserted_ = 0;
  double locate_seconds_ = 0, subdivide_seconds_ = 0;
};

}  // namespace delray::delaunay::internal
