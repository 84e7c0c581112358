#include "raster/internal/tile_view.h"

#include "raster/internal/samples.h"

namespace delray::raster {
image::RgbaF TileView::colour(std::uint32_t number, int x, int y) {
  if (shaded_ != nullptr && tile_ != nullptr) {
    const int pixel = y % kTileSize * kTileSize + x % kTileSize;
    if (number_of(tile_->key[pixel]) == number)
      return shaded_[static_cast<std::ptrdiff_t>(y % kTileSize) * frame_.screen.width +
                     x % kTileSize];
  }
  ++shaded_now_;
  return colour_at(frame_, memory_.seen, number, x, y);
}

template <class Colour>
void TileView::shade_opaque(const geometry::Rect& rect, const Window<Colour>& window) {
  if (tile_ == nullptr) {
    clear_pixels(rect, window);
    return;
  }
  if (shaded_ == nullptr) {
    const std::uint64_t shown =
        frame_.lighting == Lighting::gouraud
            ? memory_.gouraud.shade(frame_, memory_.seen, *tile_, rect, window)
            : memory_.phong.shade(frame_, memory_.seen, *tile_, rect, window);
    shown_ += shown;
    shaded_now_ += shown;
    return;
  }
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) {
      const std::int64_t key = tile_->key[y % kTileSize * kTileSize + x % kTileSize];
      const std::size_t to = window.at(x, y);
      window.depth[to] = frame_.shown_depth(key);
      window.colour[to] = {};
      if (number_of(key) == kNothing) continue;
      ++shown_;
      composite::store(colour(number_of(key), x, y), window.colour[to]);
    }
}

// The fragments of a pixel lie together.
template <class Colour>
void TileView::blend(const geometry::Rect& rect, const Window<Colour>& window) {
  const std::vector<BlendedFragment>& blended = memory_.blended;
  for (std::size_t first = 0, last; first < blended.size(); first = last) {
    const std::uint32_t pixel = blended[first].pixel;
    last = first;
    while (last < blended.size() && blended[last].pixel == pixel) ++last;
    const int x = rect.x0 / kTileSize * kTileSize + static_cast<int>(pixel % kTileSize);
    const int y = rect.y0 / kTileSize * kTileSize + static_cast<int>(pixel / kTileSize);
    if (x < rect.x0 || x >= rect.x1 || y < rect.y0 || y >= rect.y1) continue;
    memory_.fragments.clear();
    const auto add = [&](std::int64_t key) {
      const image::RgbaF seen = colour(number_of(key), x, y);
      if (seen.a > 0) memory_.fragments.push_back({seen, frame_.shown_depth(key), 0, 0});
    };
    for (std::size_t i = first; i < last; ++i) add(blended[i].key);
    shown_ += memory_.fragments.size();
    if (memory_.fragments.empty()) continue;
    if (const std::int64_t key = opaque_key(pixel); number_of(key) != kNothing) add(key);
    const std::size_t to = window.at(x, y);
    window.depth[to] = memory_.fragments.front().depth;
    composite::store(composite::blend(memory_.fragments), window.colour[to]);
  }
}

template <class Colour>
void TileView::shade(const geometry::Rect& rect, const Window<Colour>& window) {
  shade_opaque(rect, window);
  blend(rect, window);
}

template <class Colour>
void TileView::shade_pixels(const geometry::Rect& rect, int n, const Window<Colour>& window) {
  if (n == 1) {
    shade(rect, window);
  } else if (empty()) {
    clear_pixels(pixels_of(rect, n), window);
  } else {
    const Window<Colour> samples = tile_window<Colour>(rect);
    shade(rect, samples);
    resolve(samples, n, pixels_of(rect, n), window);
  }
}

template void TileView::shade(const geometry::Rect&, const Window<image::Rgba8>&);
template void TileView::shade(const geometry::Rect&, const Window<image::RgbaF>&);
template void TileView::shade_pixels(const geometry::Rect&, int, const Window<image::Rgba8>&);
template void TileView::shade_pixels(const geometry::Rect&, int, const Window<image::RgbaF>&);

}  // namespace delray::raster
