// Deep layers: all surfaces seen at a pixel travel, and whoever owns the pixel in the end blends
// them once, in one order, so that the picture does not depend on who composited what.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "composite/layer.h"
#include "image/image.h"

namespace delray::composite {

// One surface at one pixel. 28 bytes, without gaps: it travels as it is.
struct Fragment {
  image::RgbaF colour;  // alpha 1: nothing behind it is seen
  float depth = 0;      // not NaN
  std::uint32_t primitive_low = 0, primitive_high = 0;

  std::uint64_t primitive() const {
    return std::uint64_t{primitive_high} << 32 | std::uint64_t{primitive_low};
  }
};
static_assert(sizeof(Fragment) == 28);

// The order in which fragments are blended: front to back, ties by primitive number.
inline bool in_front(const Fragment& a, const Fragment& b) {
  return a.depth != b.depth ? a.depth < b.depth : a.primitive() < b.primitive();
}

// An image with a list of fragments for every pixel (Carpenter 1984). Pixel i, in row-major order,
// has fragments [lists[i].first, lists[i].first + lists[i].size), in order, none behind an opaque
// one.
struct DeepImage {
  struct List {
    std::uint64_t first = 0;
    std::uint32_t size = 0;
  };

  int width = 0, height = 0;
  std::vector<List> lists;
  std::vector<Fragment> fragments;  // in any order of pixels, gaps allowed

  DeepImage() = default;
  // No fragments. REQUIRES: w, h >= 0.
  DeepImage(int w, int h)
      : width(w), height(h), lists(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  std::span<const Fragment> at(std::size_t pixel) const {
    return std::span(fragments).subspan(lists[pixel].first, lists[pixel].size);
  }
  // Gives a pixel its fragments: sorts them and drops what lies behind an opaque one. Those that it
  // had are forgotten. O(k log k).
  void set(std::size_t pixel, std::span<Fragment> unsorted);
};

// Every pixel blended front to back in linear light, then coded; the depth is that of the first
// fragment. A single opaque fragment keeps its colour exactly. O(pixels + fragments), parallel.
template <class Colour>
image::BasicImage<Colour> flatten(const DeepImage& deep);

// A message has the runs of covered pixels in the range, 8 bytes each, 4 bytes for each pixel in
// them, and 28 for each fragment. Fragments, not pixels, count as composited: those that merge()
// compares. Which side a message comes from makes no difference.
class DeepLayer final : public Layer {
 public:
  explicit DeepLayer(DeepImage&& image) : image_(std::move(image)) {}

  const DeepImage& image() const { return image_; }

  std::uint64_t pixels() const override { return image_.lists.size(); }
  comm::Buffer cut(PixelRange range) override;
  std::uint64_t merge(PixelRange range, const comm::Buffer& pixels, Side from) override;
  void replace(PixelRange range, const comm::Buffer& pixels) override;
  bool empty() const override;

 private:
  DeepImage image_;
};

std::unique_ptr<Layer> make_deep(DeepImage&& image);

extern template image::Image8 flatten(const DeepImage& deep);
extern template image::ImageF flatten(const DeepImage& deep);

}  // namespace delray::composite
