// Widens float coordinates to double, which is exact, and triangulates those.
#include <array>
#include <vector>

#include "delaunay/mesh/arguments.h"
#include "delaunay/triangulate.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

template <std::size_t D>
Result triangulate_in(PointView<float> points, const Options& options) {
  std::vector<std::array<double, D>> doubles(points.size());
  constexpr std::size_t kGrain = 65536;  // points: about 0.1 ms
  parallel::parallel_for(0, points.size(), kGrain, [&](std::size_t i) {
    for (std::size_t k = 0; k < D; ++k) doubles[i][k] = points(i, static_cast<int>(k));
  });
  return triangulate(view(doubles), options);
}

}  // namespace

Result triangulate(PointView<float> points, const Options& options) {
  internal::check_view(points, options.dim);
  return options.dim == 3 ? triangulate_in<3>(points, options) : triangulate_in<2>(points, options);
}

}  // namespace delray::delaunay
