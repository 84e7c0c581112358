// Runs of pixels in which nothing is to be changed are not written to.
#include "raster/distribute/distances.h"

#include <algorithm>
#include <cstdint>

#include "parallel/parallel_for.h"
#include "raster/pipeline/screen.h"

namespace delray::raster {
namespace {

constexpr std::size_t kGrain = 1 << 14;  // pixels: a few microseconds

void convert(float* depths, std::size_t count, const scenes::View& view) {
  constexpr std::size_t kRun = 64;
  for (std::size_t first = 0; first < count; first += kRun) {
    const std::size_t last = std::min(first + kRun, count);
    // Branchless, so that the compiler vectorizes it.
    bool any = false;
    for (std::size_t i = first; i < last; ++i) any |= depths[i] < 0;
    if (!any) continue;
    for (std::size_t i = first; i < last; ++i) {
      const float distance = distance_of(depths[i], view);
      depths[i] = depths[i] < 0 ? distance : depths[i];
    }
  }
}

}  // namespace

void to_distances(std::span<float> depths, const scenes::View& view) {
  parallel::parallel_blocks(0, depths.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    convert(depths.data() + begin, end - begin, view);
  });
}

template <class Colour>
void to_distances(const geometry::Rect& rect, const Window<Colour>& window,
                  const scenes::View& view) {
  if (rect.empty()) return;
  for (int y = rect.y0; y < rect.y1; ++y)
    convert(window.depth + window.at(rect.x0, y), static_cast<std::size_t>(rect.width()), view);
}

template void to_distances(const geometry::Rect&, const Window<image::Rgba8>&, const scenes::View&);
template void to_distances(const geometry::Rect&, const Window<image::RgbaF>&, const scenes::View&);

}  // namespace delray::raster
