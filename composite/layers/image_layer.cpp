// Merges, replaces and prunes pixels of an image by either operator: the nearest by depth, or
// blending in front or behind. One function for pixels that all travel, one for those of a mask.
//
// Degenerate: of equal depths the lower rank wins, which has the lower primitive numbers where
// ranks have ascending primitives (sort-last); pruning keeps what is nearer than what arrives, or
// lies behind something that can be seen through.
#include "composite/image_layer.h"

#include <algorithm>
#include <bit>

#include "composite/layers/active_pixels.h"

namespace delray::composite {
namespace {

using internal::hides;

// Depths of an image over which another is blended: where that has a depth it lies in front.
void put_depths_in_front(std::span<float> depth, const float* front) {
  for (std::size_t i = 0; i < depth.size(); ++i) {
    depth[i] = front[i] == image::kEmptyDepth ? depth[i] : front[i];
  }
}
// Depths of an image that is blended over another: that one shows where there is no depth yet.
void put_depths_behind(std::span<float> depth, const float* back) {
  for (std::size_t i = 0; i < depth.size(); ++i) {
    depth[i] = depth[i] == image::kEmptyDepth ? back[i] : depth[i];
  }
}

// Calls f(i, k) for the k-th set bit, i.
template <class F>
void for_each_bit(const GroupMask& mask, F&& f) {
  std::size_t k = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    for (std::uint64_t bits = mask[i]; bits != 0; bits &= bits - 1) {
      f(i * 64 + static_cast<std::size_t>(std::countr_zero(bits)), k++);
    }
  }
}

}  // namespace

template <class Colour>
bool ImageLayer<Colour>::empty() const {
  // In strides, so that a pixel that is covered is found soon wherever it lies.
  constexpr std::size_t kStride = 32;
  for (std::size_t first = 0; first < kStride; ++first) {
    for (std::size_t begin = first * kGroupPixels; begin < image_.pixels();
         begin += kStride * kGroupPixels) {
      GroupMask mask{};
      if (find_covered(begin, std::min(begin + kGroupPixels, image_.pixels()), mask) > 0) {
        return false;
      }
    }
  }
  return true;
}

template <class Colour>
std::uint64_t ImageLayer<Colour>::find_covered(std::size_t begin, std::size_t end,
                                               GroupMask& mask) const {
  if (!shown_.is_known()) return find_in_all(begin, end, mask);
  // Block by block of the mask, of which those that may be covered are looked at together.
  constexpr std::size_t kBlock = ShownBlocks::kPixels;
  std::uint64_t covered = 0;
  for (std::size_t first = begin; first < end;) {
    std::size_t last = first;
    while (last < end && shown_.any(last, kBlock)) last += kBlock;
    if (last > first) {
      GroupMask some{};
      covered += find_in_all(first, std::min(last, end), some);
      std::copy_n(some.begin(), (last - first) / kBlock, mask.begin() + (first - begin) / kBlock);
    }
    first = last + kBlock;
  }
  return covered;
}

template <class Colour>
std::uint64_t ImageLayer<Colour>::find_in_all(std::size_t begin, std::size_t end,
                                              GroupMask& mask) const {
  return operator_ != Operator::over
             ? internal::find_covered(image_.depth.span().subspan(begin, end - begin), mask)
             : internal::find_coloured(image_.colour.span().subspan(begin, end - begin), mask);
}

// Forgets a pixel that element k of what arrived hides.
template <class Colour>
void ImageLayer<Colour>::prune_pixel(std::size_t pixel, const Pixels& others, std::size_t k) {
  if (operator_ == Operator::nearest ? image_.depth[pixel] < others.depth[k]
                                     : !hides(others.colour[k])) {
    return;
  }
  image_.colour[pixel] = background_;
  if (has_depth()) image_.depth[pixel] = image::kEmptyDepth;
}

template <class Colour>
void ImageLayer<Colour>::apply_to_all(Action action, std::size_t first, std::size_t size,
                                      const Pixels& pixels) {
  if (shown_.is_known()) shown_.add(first, size);
  const std::span colour = image_.colour.span().subspan(first, size);
  const std::span depth = image_.depth.span().subspan(first, size);
  const std::span other(pixels.colour, size);
  if (action == Action::replace) {
    std::copy(other.begin(), other.end(), colour.begin());
    if (has_depth()) std::copy_n(pixels.depth, size, depth.begin());
  } else if (action == Action::prune) {
    for (std::size_t i = 0; i < size; ++i) prune_pixel(first + i, pixels, i);
  } else if (operator_ == Operator::nearest) {
    image::z_merge(colour, depth, other, std::span(pixels.depth, size),
                   action == Action::merge_lower ? image::Tie::other : image::Tie::target);
  } else if (action == Action::merge_lower) {
    image::blend_front(colour, other);
    if (has_depth()) put_depths_in_front(depth, pixels.depth);
  } else {
    image::blend_back(colour, other);
    if (has_depth()) put_depths_behind(depth, pixels.depth);
  }
}

template <class Colour>
void ImageLayer<Colour>::apply_to_covered(Action action, std::size_t first, std::size_t size,
                                          const GroupMask& mask, const Pixels& covered) {
  if (shown_.is_known()) shown_.add(first, mask);
  Colour* const colour = image_.colour.data() + first;
  float* const depth = image_.depth.data() + first;
  if (action == Action::replace) {
    internal::expand(covered.colour, covered.readable, mask, background_, std::span(colour, size));
    if (has_depth()) {
      internal::expand(covered.depth, covered.readable, mask, std::span(depth, size));
    }
  } else if (action == Action::prune) {
    for_each_bit(mask, [&](std::size_t i, std::size_t k) { prune_pixel(first + i, covered, k); });
  } else if (operator_ == Operator::nearest) {
    internal::z_merge(colour, depth, mask, {covered.colour, covered.depth, covered.readable},
                      action == Action::merge_higher ? image::Tie::target : image::Tie::other);
  } else {
    const bool in_front = action != Action::merge_higher;
    internal::blend(colour, size, mask, {covered.colour, nullptr, covered.readable}, in_front);
    if (!has_depth()) return;
    for_each_bit(mask, [&](std::size_t i, std::size_t k) {
      if (in_front || depth[i] == image::kEmptyDepth) depth[i] = covered.depth[k];
    });
  }
}

template <class Colour>
void ImageLayer<Colour>::apply_to_none(Action action, std::size_t first, std::size_t size) {
  if (action != Action::replace) return;
  std::fill_n(image_.colour.data() + first, size, background_);
  if (has_depth()) std::fill_n(image_.depth.data() + first, size, image::kEmptyDepth);
}

template class ImageLayer<image::Rgba8>;
template class ImageLayer<image::RgbaF>;

}  // namespace delray::composite
