// A regular grid where the number of samples is a square, else a rank-1 lattice by the golden
// ratio.
#include "raytrace/sampling/samples.h"

namespace delray::raytrace {

glm::vec2 sample_position(int i, int n) {
  int side = 1;
  while ((side + 1) * (side + 1) <= n) ++side;
  if (side * side == n) {
    const auto whole = static_cast<float>(side);
    return {(static_cast<float>(i % side) + 0.5F) / whole,
            (static_cast<float>(i / side) + 0.5F) / whole};
  }
  constexpr double kGolden = 0.61803398874989485;
  const double y = (i + 0.5) * kGolden;
  return {(static_cast<float>(i) + 0.5F) / static_cast<float>(n),
          static_cast<float>(y - static_cast<double>(static_cast<long long>(y)))};
}

}  // namespace delray::raytrace
