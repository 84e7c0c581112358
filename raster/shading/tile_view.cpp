// Shades what a tile shows: opaque pixels by the tile's lighting, then blended ones front to back
// (Carpenter 1984), layer by layer over all pixels at once, up to the first surface that nothing is
// seen through.
#include "raster/shading/tile_view.h"

#include <numeric>

#include "raster/pipeline/samples.h"
#include "raster/shading/shade_splats.h"

namespace delray::raster {
image::RgbaF TileView::colour(std::uint32_t number, int x, int y) {
  if (shaded_.colour != nullptr && tile_ != nullptr &&
      number_of(tile_->key[pixel_of(x, y)]) == number)
    return shaded_.at(x, y);
  ++shaded_now_;
  return colour_at(frame_, memory_.seen, number, x, y);
}

template <class Colour>
void TileView::shade_opaque(const geometry::Rect& rect, const Window<Colour>& window) {
  if (tile_ == nullptr) {
    clear_pixels(rect, window);
    return;
  }
  if (shaded_.colour == nullptr) {
    const std::uint64_t shown =
        frame_.all_plain ? shade_plain_splats(frame_, *tile_, rect, window)
        : frame_.lighting == Lighting::gouraud
            ? memory_.gouraud.shade(frame_, memory_.seen, *tile_, rect, window)
            : memory_.phong.shade(frame_, memory_.seen, *tile_, rect, window);
    shown_ += shown;
    shaded_now_ += shown;
    return;
  }
  for (int y = rect.y0; y < rect.y1; ++y) {
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
}

void TileView::shade_asked() {
  const std::vector<SurfaceAt>& asked = memory_.asked;
  memory_.answers.resize(asked.size());
  if (shaded_.colour == nullptr) {
    shaded_now_ += asked.size();
    if (frame_.lighting == Lighting::gouraud)
      memory_.gouraud.colours(frame_, memory_.seen, asked, memory_.answers.data());
    else
      memory_.phong.colours(frame_, memory_.seen, asked, memory_.answers.data());
    return;
  }
  for (std::size_t i = 0; i < asked.size(); ++i)
    memory_.answers[i] = colour(asked[i].number, asked[i].x, asked[i].y);
}

// First what is in front at all pixels, then what is next where something is seen through that.
void TileView::shade_surfaces(const geometry::Rect& rect, bool blended_only) {
  std::vector<SurfaceSeen>& surfaces = memory_.surfaces;
  std::vector<PixelSurfaces>& pixels = memory_.pixels;
  surfaces.clear();
  pixels.clear();
  for_each_list(rect, [&](int x, int y, std::span<const std::int64_t> keys) {
    // An opaque surface comes last.
    if (blended_only && keys.front() == opaque_key(pixel_of(x, y))) return;
    pixels.push_back({x, y, static_cast<std::uint32_t>(surfaces.size()),
                      static_cast<std::uint32_t>(keys.size())});
    for (const std::int64_t key : keys) surfaces.push_back({key, {}});
  });
  std::vector<std::uint32_t>& open = memory_.open_pixels;
  open.resize(pixels.size());
  std::iota(open.begin(), open.end(), 0U);
  for (std::uint32_t layer = 0; !open.empty(); ++layer) {
    memory_.asked.clear();
    for (const std::uint32_t i : open) {
      memory_.asked.push_back(
          {number_of(surfaces[pixels[i].first + layer].key), pixels[i].x, pixels[i].y});
    }
    shade_asked();
    std::size_t still_open = 0;
    for (std::size_t k = 0; k < open.size(); ++k) {
      PixelSurfaces& pixel = pixels[open[k]];
      SurfaceSeen& surface = surfaces[pixel.first + layer];
      surface.colour = memory_.answers[k];
      const bool counted = blended_only && surface.key == opaque_key(pixel_of(pixel.x, pixel.y));
      shown_ += surface.colour.a > 0 && !counted;
      if (composite::is_opaque(memory_.answers[k])) pixel.count = layer + 1;
      if (layer + 1 < pixel.count) open[still_open++] = open[k];
    }
    open.resize(still_open);
  }
}

template <class Colour>
void TileView::blend(const geometry::Rect& rect, const Window<Colour>& window) {
  if (memory_.blended.empty()) return;
  shade_surfaces(rect, true);
  for (const PixelSurfaces& pixel : memory_.pixels) {
    memory_.fragments.clear();
    for (std::uint32_t i = pixel.first; i < pixel.first + pixel.count; ++i) {
      const SurfaceSeen& surface = memory_.surfaces[i];
      if (surface.colour.a > 0)
        memory_.fragments.push_back({surface.colour, frame_.shown_depth(surface.key), 0, 0});
    }
    if (memory_.fragments.empty()) continue;
    const std::size_t to = window.at(pixel.x, pixel.y);
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
