// Runs of pixels in which nothing is to be changed are not written to. Degenerate: many small
// rectangles are shared out to threads as they are, a few large ones by rows.
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
void to_distances(image::BasicImage<Colour>& image, std::span<const geometry::Rect> rects,
                  const scenes::View& view) {
  std::uint64_t pixels = 0;
  for (const geometry::Rect& rect : rects) pixels += static_cast<std::uint64_t>(rect.area());
  if (pixels == 0) return;
  const auto convert_row = [&](const geometry::Rect& rect, int y) {
    const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(rect.x0);
    convert(image.depth.data() + at, static_cast<std::size_t>(rect.width()), view);
  };
  const std::uint64_t mean = pixels / rects.size();
  if (mean < kGrain) {
    const std::size_t together = std::max<std::size_t>(kGrain / std::max<std::size_t>(mean, 1), 1);
    parallel::parallel_for(0, rects.size(), together, [&](std::size_t i) {
      for (int y = rects[i].y0; y < rects[i].y1; ++y) convert_row(rects[i], y);
    });
    return;
  }
  for (const geometry::Rect& rect : rects) {
    if (rect.empty()) continue;
    const auto width = static_cast<std::size_t>(rect.width());
    parallel::parallel_for(
        0, static_cast<std::size_t>(rect.height()), std::max<std::size_t>(kGrain / width, 1),
        [&](std::size_t row) { convert_row(rect, rect.y0 + static_cast<int>(row)); });
  }
}

template void to_distances(image::Image8&, std::span<const geometry::Rect>, const scenes::View&);
template void to_distances(image::ImageF&, std::span<const geometry::Rect>, const scenes::View&);

}  // namespace delray::raster
