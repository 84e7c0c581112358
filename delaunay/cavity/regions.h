// The parts of space that cavity kernels may work in.
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace delray::delaunay::internal {

struct Everywhere {
  static constexpr bool contains(const glm::dvec3&) { return true; }
};

// A box that is open above and need not be bounded: everywhere without cuts. Convex, so that a
// search from one of its points to another seldom leaves it.
class Box3Region {
 public:
  bool is_everywhere() const { return count_ == 0; }
  bool contains(const glm::dvec3& p) const {
    for (int i = 0; i < count_; ++i) {
      const Cut& cut = cuts_[static_cast<std::size_t>(i)];
      if ((p[cut.axis] < cut.at) != cut.below) return false;
    }
    return true;
  }
  // The part on one side of a plane. REQUIRES: fewer than kMaximumCuts so far.
  Box3Region cut(int axis, double at, bool below) const {
    Box3Region result = *this;
    result.cuts_[static_cast<std::size_t>(result.count_++)] = {at, axis, below};
    return result;
  }

  static constexpr int kMaximumCuts = 12;

 private:
  struct Cut {
    double at;
    int axis;
    bool below;
  };
  std::array<Cut, kMaximumCuts> cuts_;
  int count_ = 0;
};

}  // namespace delray::delaunay::internal
