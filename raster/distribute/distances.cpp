// Depths are negative and distances are not. Runs of pixels in which nothing is to be changed are
// not written to.
#include "raster/distribute/distances.h"

#include <algorithm>

#include "parallel/parallel_for.h"
#include "raster/pipeline/screen.h"

namespace delray::raster {

void to_distances(std::span<float> depths, const scenes::View& view) {
  constexpr std::size_t kGrain = 1 << 16;  // pixels: some ten microseconds
  parallel::parallel_blocks(0, depths.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t kRun = 64;
    for (std::size_t first = begin; first < end; first += kRun) {
      const std::size_t last = std::min(first + kRun, end);
      // Branchless, so that the compiler vectorizes it.
      bool any = false;
      for (std::size_t i = first; i < last; ++i) any |= depths[i] < 0;
      if (!any) continue;
      for (std::size_t i = first; i < last; ++i) {
        const float distance = distance_of(depths[i], view);
        depths[i] = depths[i] < 0 ? distance : depths[i];
      }
    }
  });
}

}  // namespace delray::raster
