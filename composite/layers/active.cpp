// Cuts and merges ranges of which only the covered pixels travel, in parallel over groups of
// pixels. Full and empty groups are copied and skipped as a whole; mixed ones go through the vector
// loops of active_pixels.cpp.
#include "composite/layers/active.h"

#include <algorithm>
#include <cassert>

#include "comm/bad_message.h"
#include "composite/coverage.h"
#include "composite/layers/active_pixels.h"
#include "composite/layers/encode_active.h"
#include "parallel/parallel_for.h"

namespace delray::composite {
template <class Colour>
comm::Buffer ActiveLayer<Colour>::encode(PixelRange range) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  const Colour* const colour = this->image().colour.data() + range.begin;
  const float* const depth = this->image().depth.data() + range.begin;
  const Coverage coverage(range.size(),
                          [&](std::uint64_t begin, std::uint64_t end, GroupMask& mask) {
                            return this->find_covered(range.begin + begin, range.begin + end, mask);
                          });
  struct View {
    const Colour* colour;
    const float* depth;
  };
  return internal::encode_active<Colour>(coverage, this->has_depth(),
                                         [&](std::uint64_t begin, std::uint64_t /*end*/) {
                                           return View{colour + begin, depth + begin};
                                         });
}

template <class Colour>
std::uint64_t ActiveLayer<Colour>::apply(PixelRange range, const comm::Buffer& pixels,
                                         Action action) {
  return apply_covered(range, Coverage(range.size(), {pixels.data(), pixels.size()}), pixels,
                       action);
}

template <class Colour>
std::uint64_t ActiveLayer<Colour>::apply_covered(PixelRange range, const Coverage& coverage,
                                                 const comm::Buffer& pixels, Action action) {
  assert(range.begin <= range.end && range.end <= this->pixels());
  const std::uint64_t covered = coverage.covered();
  comm::check_message(pixels.size() ==
                      coverage.encoded_bytes() + covered * this->bytes_per_pixel());
  const auto* colour = reinterpret_cast<const Colour*>(pixels.data() + coverage.encoded_bytes());
  const auto* depth = reinterpret_cast<const float*>(colour + covered);
  parallel::parallel_for(0, coverage.groups(), internal::kGroupsGrain, [&](std::size_t i) {
    const Coverage::Group at = coverage.group(i);
    const std::size_t first = range.begin + at.begin, size = at.end - at.begin;
    const typename ImageLayer<Colour>::Pixels arrived{
        colour + at.covered_before, this->has_depth() ? depth + at.covered_before : nullptr,
        covered - at.covered_before};
    if (at.covered == 0) {
      this->apply_to_none(action, first, size);
    } else if (at.is_full()) {
      this->apply_to_all(action, first, size, arrived);
    } else {
      this->apply_to_covered(action, first, size, coverage.mask(i), arrived);
    }
  });
  return covered;
}

template class ActiveLayer<image::Rgba8>;
template class ActiveLayer<image::RgbaF>;

std::unique_ptr<Layer> make_active(image::Image8&& image, Operator how) {
  return std::make_unique<ActiveLayer<image::Rgba8>>(std::move(image), how);
}

std::unique_ptr<Layer> make_active(image::ImageF&& image, Operator how) {
  return std::make_unique<ActiveLayer<image::RgbaF>>(std::move(image), how);
}

}  // namespace delray::composite
