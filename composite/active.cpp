#include "composite/active.h"

#include <algorithm>
#include <cassert>

#include "composite/coverage.h"
#include "composite/internal/active_pixels.h"
#include "parallel/parallel_for.h"

namespace delray::composite {
namespace {

constexpr std::size_t kGrain = 4;  // groups of 4096 pixels; some ten microseconds

// What cut() wrote.
template <class Colour>
struct Encoded {
  Coverage coverage;
  const Colour* colour;
  const float* depth;

  Encoded(PixelRange range, const comm::Buffer& message)
      : coverage(range.size(), message.data()),
        colour(reinterpret_cast<const Colour*>(message.data() + coverage.encoded_bytes())),
        depth(reinterpret_cast<const float*>(colour + coverage.covered())) {
    assert(reinterpret_cast<const std::byte*>(depth + coverage.covered()) ==
           message.data() + message.size());
  }
  // From a group's first one on.
  internal::ActivePixels<Colour> pixels(const Coverage::Group& at) const {
    return {colour + at.covered_before, depth + at.covered_before,
            coverage.covered() - at.covered_before};
  }
};

// z-merge of what arrived for one group of the range.
template <class Colour>
void merge_group(image::BasicImage<Colour>& image, PixelRange range, const Encoded<Colour>& other,
                 std::size_t group, image::Tie tie) {
  const Coverage::Group at = other.coverage.group(group);
  if (at.covered == 0) return;
  const std::size_t first = range.begin + at.begin, size = at.end - at.begin;
  const auto pixels = other.pixels(at);
  if (at.is_full()) {
    image::z_merge(image.colour.span().subspan(first, size),
                   image.depth.span().subspan(first, size), std::span(pixels.colour, size),
                   std::span(pixels.depth, size), tie);
  } else {
    internal::z_merge(image.colour.data() + first, image.depth.data() + first,
                      other.coverage.mask(group), pixels, tie);
  }
}

}  // namespace

template <class Colour>
comm::Buffer ActiveLayer<Colour>::cut(PixelRange range) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  const Colour* const colour = this->image().colour.data() + range.begin;
  const float* const depth = this->image().depth.data() + range.begin;
  const Coverage coverage(range.size(),
                          [&](std::uint64_t begin, std::uint64_t end, GroupMask& mask) {
                            return internal::find_covered({depth + begin, end - begin}, mask);
                          });
  const std::uint64_t covered = coverage.covered();
  comm::Buffer buffer(coverage.encoded_bytes() + covered * (sizeof(Colour) + sizeof(float)));
  auto* const colours = reinterpret_cast<Colour*>(coverage.encode(buffer.data()));
  auto* const depths = reinterpret_cast<float*>(colours + covered);
  parallel::parallel_for(0, coverage.groups(), kGrain, [&](std::size_t i) {
    const Coverage::Group at = coverage.group(i);
    const std::span to_colours(colours + at.covered_before, at.covered);
    const std::span to_depths(depths + at.covered_before, at.covered);
    if (at.is_full()) {
      std::copy_n(colour + at.begin, at.covered, to_colours.begin());
      std::copy_n(depth + at.begin, at.covered, to_depths.begin());
    } else if (at.covered > 0) {
      internal::compress(colour + at.begin, coverage.mask(i), to_colours);
      internal::compress(depth + at.begin, coverage.mask(i), to_depths);
    }
  });
  return buffer;
}

template <class Colour>
std::uint64_t ActiveLayer<Colour>::merge(PixelRange range, const comm::Buffer& pixels, Side from) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  const Encoded<Colour> other(range, pixels);
  parallel::parallel_for(0, other.coverage.groups(), kGrain, [&](std::size_t i) {
    merge_group(this->image(), range, other, i, this->tie_of(from));
  });
  return other.coverage.covered();
}

template <class Colour>
void ActiveLayer<Colour>::replace(PixelRange range, const comm::Buffer& pixels) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  image::BasicImage<Colour>& image = this->image();
  const Encoded<Colour> other(range, pixels);
  parallel::parallel_for(0, other.coverage.groups(), kGrain, [&](std::size_t i) {
    const Coverage::Group at = other.coverage.group(i);
    const std::size_t first = range.begin + at.begin, size = at.end - at.begin;
    if (at.is_full()) {
      std::copy_n(other.pixels(at).colour, size, image.colour.data() + first);
      std::copy_n(other.pixels(at).depth, size, image.depth.data() + first);
      return;
    }
    std::fill_n(image.colour.data() + first, size, Colour{});
    std::fill_n(image.depth.data() + first, size, image::kEmptyDepth);
    merge_group(image, range, other, i, image::Tie::other);
  });
}

template class ActiveLayer<image::Rgba8>;
template class ActiveLayer<image::RgbaF>;

std::unique_ptr<Layer> make_active(image::Image8&& image) {
  return std::make_unique<ActiveLayer<image::Rgba8>>(std::move(image));
}

std::unique_ptr<Layer> make_active(image::ImageF&& image) {
  return std::make_unique<ActiveLayer<image::RgbaF>>(std::move(image));
}

}  // namespace delray::composite
