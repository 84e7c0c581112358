// A tile in which everything is drawn: where strategies get their pixels from.
#pragma once

#include <span>
#include <vector>

#include "composite/deep.h"
#include "raster/shading/blended.h"
#include "raster/shading/shade_gouraud.h"
#include "raster/shading/shade_phong.h"

namespace delray::raster {

// A surface that is seen at a pixel: a key and, premultiplied, a colour.
struct SurfaceSeen {
  std::int64_t key;
  image::RgbaF colour;
};
// Surfaces [first, first + count) of a tile's are at pixel (x, y).
struct PixelSurfaces {
  int x, y;
  std::uint32_t first, count;
};

// Memory of a thread for one tile after the other.
struct TileMemory {
  SeenTriangles seen;
  GouraudTile gouraud;
  PhongTile phong;
  VisibilityTile visibility;  // of a tile in which there are large triangles only
  std::vector<BlendedFragment> blended;
  std::vector<composite::Fragment> fragments;
  std::vector<std::int64_t> keys;
  std::vector<int> seen_in;  // by draw that has a holder: the last tile that showed it
  // For for_each_surface.
  std::vector<SurfaceSeen> surfaces;
  std::vector<PixelSurfaces> pixels;
  std::vector<std::uint32_t> open_pixels;
  std::vector<SurfaceAt> asked;
  std::vector<image::RgbaF> answers;
};

// Colours of a tile's pixels that were shaded as they were drawn; null: they were not.
struct ShadedPixels {
  const image::RgbaF* colour = nullptr;  // of the tile's first pixel
  std::ptrdiff_t stride = 0;             // from row to row

  const image::RgbaF& at(int x, int y) const {
    return colour[y % kTileSize * stride + x % kTileSize];
  }
};

class TileView {
 public:
  // `tile` is null where nothing opaque was drawn; memory.blended is what is before it, by pixel
  // and front to back.
  TileView(const FrameShading& frame, const VisibilityTile* tile, const ShadedPixels& shaded,
           TileMemory& memory)
      : frame_(frame), tile_(tile), shaded_(shaded), memory_(memory) {}

  // Of the same tile with a part of what this one shows.
  TileView of_part(const VisibilityTile& part) const { return {frame_, &part, shaded_, memory_}; }
  void count(const TileView& part) {
    shown_ += part.shown_;
    shaded_now_ += part.shaded_now_;
  }

  const FrameShading& frame() const { return frame_; }
  // What is opaque; null where nothing is.
  const VisibilityTile* opaque() const { return tile_; }
  SeenTriangles& seen() { return memory_.seen; }
  bool empty() const { return tile_ == nullptr && memory_.blended.empty(); }
  // Surfaces that were seen at the pixels asked for so far, and how many of them were shaded.
  std::uint64_t shown() const { return shown_; }
  std::uint64_t shaded() const { return shaded_now_; }

  // Colour and depth of the pixels of `rect`, within the tile, into the window.
  template <class Colour>
  void shade(const geometry::Rect& rect, const Window<Colour>& window);
  // As shade, averaged over pixels of n x n samples, for a window of pixels; `rect` is in samples.
  //
  // REQUIRES: rect is of whole pixels.
  template <class Colour>
  void shade_pixels(const geometry::Rect& rect, int n, const Window<Colour>& window);
  // The opaque triangle that is seen at a pixel, behind whatever is blended; kNothing if none is.
  std::uint32_t opaque_number(int x, int y) const { return number_of(opaque_key(pixel_of(x, y))); }

  // Calls f(x, y, keys) for every pixel of `rect` at which anything is seen, row by row, with the
  // keys of what is seen there, front to back.
  template <class F>
  void for_each_pixel(const geometry::Rect& rect, F&& f) {
    for_each_list(rect, [&](int x, int y, std::span<const std::int64_t> keys) {
      shown_ += keys.size();
      f(x, y, keys);
    });
  }
  // Calls f(x, y, surfaces), the SurfaceSeens of each such pixel up to the first that nothing is
  // seen through.
  template <class F>
  void for_each_surface(const geometry::Rect& rect, F&& f) {
    shade_surfaces(rect, false);
    for (const PixelSurfaces& pixel : memory_.pixels) {
      f(pixel.x, pixel.y,
        std::span<const SurfaceSeen>(memory_.surfaces).subspan(pixel.first, pixel.count));
    }
  }

  // The colour of a triangle at a pixel, premultiplied.
  image::RgbaF colour(std::uint32_t number, int x, int y);

 private:
  template <class F>
  void for_each_list(const geometry::Rect& rect, F&& f);
  template <class Colour>
  void shade_opaque(const geometry::Rect& rect, const Window<Colour>& window);
  template <class Colour>
  void blend(const geometry::Rect& rect, const Window<Colour>& window);
  // Into memory_.pixels; of all pixels, or of those with something blended.
  void shade_surfaces(const geometry::Rect& rect, bool blended_only);
  void shade_asked();
  static std::uint32_t pixel_of(int x, int y) {
    return static_cast<std::uint32_t>(y % kTileSize * kTileSize + x % kTileSize);
  }
  std::int64_t opaque_key(std::uint32_t pixel) const {
    return tile_ == nullptr ? kEmptyKey : tile_->key[pixel];
  }

  const FrameShading& frame_;
  const VisibilityTile* tile_;
  const ShadedPixels shaded_;
  TileMemory& memory_;
  std::uint64_t shown_ = 0, shaded_now_ = 0;
};

template <class F>
void TileView::for_each_list(const geometry::Rect& rect, F&& f) {
  if (empty()) return;
  auto blended = memory_.blended.begin();
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) {
      const std::uint32_t pixel = pixel_of(x, y);
      while (blended != memory_.blended.end() && blended->pixel < pixel) ++blended;
      memory_.keys.clear();
      for (; blended != memory_.blended.end() && blended->pixel == pixel; ++blended)
        memory_.keys.push_back(blended->key);
      if (const std::int64_t key = opaque_key(pixel); number_of(key) != kNothing)
        memory_.keys.push_back(key);
      if (!memory_.keys.empty()) f(x, y, std::span<const std::int64_t>(memory_.keys));
    }
  }
}

}  // namespace delray::raster
