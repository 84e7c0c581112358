// Collects the pixels of blended triangles before what is opaque, and sorts them by pixel and depth
// (A-buffer: Carpenter 1984).
#include "raster/shading/blended.h"

#include <algorithm>
#include <tuple>

namespace delray::raster {

void find_blended(const Screen& screen, const geometry::Rect& rect,
                  std::span<const ScreenTriangle> triangles, std::span<const std::uint32_t> entries,
                  const VisibilityTile* tile, std::vector<BlendedFragment>& fragments) {
  fragments.clear();
  for (const std::uint32_t entry : entries) {
    for_each_covered(screen, rect, triangles[entry], [&](int i, int j, std::int64_t key) {
      const auto pixel = static_cast<std::uint32_t>(j * kTileSize + i);
      if (key < (tile == nullptr ? kEmptyKey : tile->key[pixel])) fragments.push_back({pixel, key});
    });
  }
  std::sort(fragments.begin(), fragments.end(),
            [](const BlendedFragment& a, const BlendedFragment& b) {
              return std::tie(a.pixel, a.key) < std::tie(b.pixel, b.key);
            });
}

}  // namespace delray::raster
