// Colour and depth of a rectangle of pixels.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <span>

namespace delray::image {

// 8-bit sRGB, premultiplied by alpha (in linear light, before coding); alpha itself is linear.
struct Rgba8 {
  std::uint8_t r = 0, g = 0, b = 0, a = 0;
  bool operator==(const Rgba8&) const = default;
};

// Linear light, premultiplied by alpha.
struct RgbaF {
  float r = 0, g = 0, b = 0, a = 0;
  bool operator==(const RgbaF&) const = default;
};

// The depth of a pixel that nothing covers. Smaller is nearer; what the unit is, the renderer says.
inline constexpr float kEmptyDepth = std::numeric_limits<float>::infinity();

// Vector loops may read and write up to this many bytes past the last pixel of a plane.
inline constexpr std::size_t kPlanePadding = 64;

// `size` values of T at a 64-byte boundary, followed by kPlanePadding bytes; not initialised.
template <class T>
class Plane {
 public:
  Plane() = default;
  explicit Plane(std::size_t size)
      : data_(static_cast<T*>(
            ::operator new (size * sizeof(T) + kPlanePadding, std::align_val_t{64}))),
        size_(size) {}

  std::size_t size() const { return size_; }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::span<T> span() { return {data_.get(), size_}; }
  std::span<const T> span() const { return {data_.get(), size_}; }
  T& operator[](std::size_t i) { return data_.get()[i]; }
  const T& operator[](std::size_t i) const { return data_.get()[i]; }

 private:
  struct Free {
    void operator()(T* p) const { ::operator delete (p, std::align_val_t{64}); }
  };
  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0;
};

// Row-major, top row first; pixel (x, y) is element y * width + x of both planes.
template <class Colour>
struct BasicImage {
  int width = 0, height = 0;
  Plane<Colour> colour;
  Plane<float> depth;

  BasicImage() = default;
  // Not initialised: see clear. REQUIRES: w, h >= 0.
  BasicImage(int w, int h)
      : width(w),
        height(h),
        colour(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)),
        depth(colour.size()) {}
  std::size_t pixels() const { return colour.size(); }
};

using Image8 = BasicImage<Rgba8>;
using ImageF = BasicImage<RgbaF>;

// Sets every pixel to `colour` and to no coverage.
template <class Colour>
void clear(BasicImage<Colour>& image, const Colour& colour = {}) {
  std::fill_n(image.colour.data(), image.pixels(), colour);
  std::fill_n(image.depth.data(), image.pixels(), kEmptyDepth);
}

}  // namespace delray::image
