#include "composite/image_layer.h"

#include <algorithm>
#include <bit>

#include "composite/internal/active_pixels.h"

namespace delray::composite {
namespace {

// Pixels that lie behind what arrived, where that hides them, are forgotten.
template <class Colour>
void prune_hidden(Colour* colour, float* depth, float other_depth) {
  if (*depth < other_depth) return;
  *colour = {};
  *depth = image::kEmptyDepth;
}

bool hides(image::Rgba8 colour) { return colour.a == 255; }
bool hides(image::RgbaF colour) { return colour.a == 1; }

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
  for (std::size_t begin = 0; begin < image_.pixels(); begin += kGroupPixels) {
    GroupMask mask{};
    if (find_covered(begin, std::min(begin + kGroupPixels, image_.pixels()), mask) > 0) {
      return false;
    }
  }
  return true;
}

template <class Colour>
std::uint64_t ImageLayer<Colour>::find_covered(std::size_t begin, std::size_t end,
                                               GroupMask& mask) const {
  return has_depth()
             ? internal::find_covered(image_.depth.span().subspan(begin, end - begin), mask)
             : internal::find_coloured(image_.colour.span().subspan(begin, end - begin), mask);
}

template <class Colour>
void ImageLayer<Colour>::apply_to_all(Action action, std::size_t first, std::size_t size,
                                      const Pixels& pixels) {
  const std::span colour = image_.colour.span().subspan(first, size);
  const std::span depth = image_.depth.span().subspan(first, size);
  const std::span other(pixels.colour, size);
  if (action == Action::replace) {
    std::copy(other.begin(), other.end(), colour.begin());
    if (has_depth()) std::copy_n(pixels.depth, size, depth.begin());
  } else if (action == Action::prune) {
    for (std::size_t i = 0; i < size; ++i) {
      if (has_depth()) {
        prune_hidden(&colour[i], &depth[i], pixels.depth[i]);
      } else if (hides(other[i])) {
        colour[i] = {};
      }
    }
  } else if (has_depth()) {
    image::z_merge(colour, depth, other, std::span(pixels.depth, size),
                   action == Action::merge_lower ? image::Tie::other : image::Tie::target);
  } else if (action == Action::merge_lower) {
    image::blend_front(colour, other);
  } else {
    image::blend_back(colour, other);
  }
}

template <class Colour>
void ImageLayer<Colour>::apply_to_covered(Action action, std::size_t first, std::size_t size,
                                          const GroupMask& mask, const Pixels& covered) {
  Colour* const colour = image_.colour.data() + first;
  float* const depth = image_.depth.data() + first;
  if (action == Action::replace) {
    internal::expand(covered.colour, covered.readable, mask, std::span(colour, size));
    if (has_depth()) {
      internal::expand(covered.depth, covered.readable, mask, std::span(depth, size));
    }
  } else if (action == Action::prune) {
    for_each_bit(mask, [&](std::size_t i, std::size_t k) {
      if (has_depth()) {
        prune_hidden(colour + i, depth + i, covered.depth[k]);
      } else if (hides(covered.colour[k])) {
        colour[i] = {};
      }
    });
  } else if (has_depth()) {
    internal::z_merge(colour, depth, mask, {covered.colour, covered.depth, covered.readable},
                      action == Action::merge_higher ? image::Tie::target : image::Tie::other);
  } else {
    internal::blend(colour, size, mask, {covered.colour, nullptr, covered.readable},
                    action != Action::merge_higher);
  }
}

template <class Colour>
void ImageLayer<Colour>::apply_to_none(Action action, std::size_t first, std::size_t size) {
  if (action != Action::replace) return;
  std::fill_n(image_.colour.data() + first, size, Colour{});
  if (has_depth()) std::fill_n(image_.depth.data() + first, size, image::kEmptyDepth);
}

template class ImageLayer<image::Rgba8>;
template class ImageLayer<image::RgbaF>;

}  // namespace delray::composite
