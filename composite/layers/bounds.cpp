// Cuts and merges the rectangle around covered pixels, in parallel over its rows. Degenerate: a
// range without covered pixels is an empty rectangle, and its message is the rectangle alone.
#include "composite/layers/bounds.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <vector>

#include "comm/bad_message.h"
#include "composite/layers/bounding_rectangle.h"
#include "parallel/parallel_for.h"

namespace delray::composite {
namespace {

using internal::Bounds;
using internal::bounds_of;
using internal::run_of;

constexpr std::size_t kRowsGrain = 16;  // rows; some ten microseconds

// Runs of all rows, and how many pixels lie in those before each; one element more.
struct Runs {
  std::vector<PixelRange> ranges;
  std::vector<std::uint64_t> before{0};

  Runs(const Bounds& bounds, std::uint64_t width, PixelRange range) {
    for (std::uint32_t y = bounds.y0; y < bounds.y1; ++y) {
      ranges.push_back(run_of(bounds, y, width, range));
      before.push_back(before.back() + ranges.back().size());
    }
  }
};

}  // namespace

template <class Colour>
comm::Buffer BoundsLayer<Colour>::encode(PixelRange range) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  const image::BasicImage<Colour>& image = this->image();
  const auto width = static_cast<std::uint64_t>(image.width);
  const Bounds bounds =
      bounds_of(range, width, [&](std::uint64_t begin, std::uint64_t end, GroupMask& mask) {
        return this->find_covered(begin, end, mask);
      });
  const Runs runs(bounds, width, range);
  comm::Buffer buffer(sizeof bounds + runs.before.back() * this->bytes_per_pixel());
  std::memcpy(buffer.data(), &bounds, sizeof bounds);
  auto* const colour = reinterpret_cast<Colour*>(buffer.data() + sizeof bounds);
  auto* const depth = reinterpret_cast<float*>(colour + runs.before.back());
  parallel::parallel_for(0, runs.ranges.size(), kRowsGrain, [&](std::size_t i) {
    const PixelRange run = runs.ranges[i];
    std::copy_n(image.colour.data() + run.begin, run.size(), colour + runs.before[i]);
    if (this->has_depth()) {
      std::copy_n(image.depth.data() + run.begin, run.size(), depth + runs.before[i]);
    }
  });
  return buffer;
}

template <class Colour>
std::uint64_t BoundsLayer<Colour>::apply(PixelRange range, const comm::Buffer& pixels,
                                         Action action) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  Bounds bounds;
  comm::check_message(pixels.size() >= sizeof bounds);
  std::memcpy(&bounds, pixels.data(), sizeof bounds);
  comm::check_message(bounds.x0 <= bounds.x1 && bounds.y0 <= bounds.y1 &&
                      bounds.x1 <= static_cast<std::uint32_t>(this->image().width) &&
                      bounds.y1 <= static_cast<std::uint32_t>(this->image().height));
  const Runs runs(bounds, static_cast<std::uint64_t>(this->image().width), range);
  const std::uint64_t all = runs.before.back();
  comm::check_message(pixels.size() == sizeof bounds + all * this->bytes_per_pixel());
  const auto* const colour = reinterpret_cast<const Colour*>(pixels.data() + sizeof bounds);
  const auto* const depth = reinterpret_cast<const float*>(colour + all);
  if (all < range.size()) this->apply_to_none(action, range.begin, range.size());
  parallel::parallel_for(0, runs.ranges.size(), kRowsGrain, [&](std::size_t i) {
    const PixelRange run = runs.ranges[i];
    const std::uint64_t at = runs.before[i];
    this->apply_to_all(action, run.begin, run.size(),
                       {colour + at, this->has_depth() ? depth + at : nullptr, all - at});
  });
  return all;
}

template class BoundsLayer<image::Rgba8>;
template class BoundsLayer<image::RgbaF>;

std::unique_ptr<Layer> make_bounds(image::Image8&& image, Operator how) {
  return std::make_unique<BoundsLayer<image::Rgba8>>(std::move(image), how);
}

std::unique_ptr<Layer> make_bounds(image::ImageF&& image, Operator how) {
  return std::make_unique<BoundsLayer<image::RgbaF>>(std::move(image), how);
}

}  // namespace delray::composite
