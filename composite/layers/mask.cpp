// Bit masks of pixels in groups that take memory once a bit is set, read and changed 64 pixels at a
// time at any offset; and the masks of images one rank after the other, with those pixels that no
// lower rank hides.
#include "composite/mask.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "composite/layers/active_pixels.h"

namespace delray::composite {
namespace {

constexpr std::uint64_t kElementPixels = 64;
constexpr std::uint64_t kGroupElements = kGroupPixels / kElementPixels;

// The lowest `count` bits.
std::uint64_t low_bits(std::uint64_t count) {
  return count >= kElementPixels ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

}  // namespace

PixelMask::PixelMask(std::uint64_t pixels)
    : pixels_(pixels), groups_((pixels + kGroupPixels - 1) / kGroupPixels) {}

PixelMask PixelMask::copy() const {
  PixelMask result(pixels_);
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    if (groups_[i]) result.groups_[i] = std::make_unique<GroupMask>(*groups_[i]);
  }
  return result;
}

bool PixelMask::empty() const {
  return std::all_of(groups_.begin(), groups_.end(), [](const auto& group) {
    return !group || std::all_of(group->begin(), group->end(), [](auto bits) { return bits == 0; });
  });
}

template <class F>
bool PixelMask::for_elements(PixelRange range, F&& f) const {
  assert(range.begin <= range.end && range.end <= pixels_);
  for (std::uint64_t at = range.begin; at < range.end;) {
    const std::uint64_t group_end = std::min((at / kGroupPixels + 1) * kGroupPixels, range.end);
    if (!groups_[at / kGroupPixels]) {
      at = group_end;
      continue;
    }
    const std::uint64_t shift = at % kElementPixels;
    const std::uint64_t count = std::min(kElementPixels - shift, group_end - at);
    if (!f(at / kElementPixels, low_bits(count) << shift)) return false;
    at += count;
  }
  return true;
}

bool PixelMask::empty(PixelRange range) const {
  return for_elements(
      range, [&](std::uint64_t i, std::uint64_t bits) { return (element(i) & bits) == 0; });
}

std::uint64_t PixelMask::element(std::uint64_t i) const {
  if (i / kGroupElements >= groups_.size()) return 0;
  const auto& group = groups_[i / kGroupElements];
  return group ? (*group)[i % kGroupElements] : 0;
}

std::uint64_t& PixelMask::writable_element(std::uint64_t i) {
  auto& group = groups_[i / kGroupElements];
  if (!group) {
    group = std::make_unique<GroupMask>();
    group->fill(0);
  }
  return (*group)[i % kGroupElements];
}

std::uint64_t PixelMask::read(std::uint64_t begin, std::uint64_t end, GroupMask& mask) const {
  assert(begin <= end && end <= pixels_ && end - begin <= kGroupPixels);
  if (begin == end) return 0;
  if (!groups_[begin / kGroupPixels] && !groups_[(end - 1) / kGroupPixels]) return 0;
  const std::uint64_t first = begin / kElementPixels, shift = begin % kElementPixels;
  std::uint64_t count = 0;
  for (std::uint64_t i = 0; i * kElementPixels < end - begin; ++i) {
    std::uint64_t bits = element(first + i) >> shift;
    if (shift > 0) bits |= element(first + i + 1) << (kElementPixels - shift);
    bits &= low_bits(end - begin - i * kElementPixels);
    mask[i] = bits;
    count += static_cast<std::uint64_t>(std::popcount(bits));
  }
  return count;
}

void PixelMask::add(std::uint64_t begin, const GroupMask& mask) {
  const std::uint64_t first = begin / kElementPixels, shift = begin % kElementPixels;
  for (std::uint64_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    const std::uint64_t low = mask[i] << shift;
    const std::uint64_t high = shift > 0 ? mask[i] >> (kElementPixels - shift) : 0;
    if (low != 0) writable_element(first + i) |= low;
    if (high != 0) writable_element(first + i + 1) |= high;
  }
}

void PixelMask::remove(std::uint64_t begin, const GroupMask& mask) {
  const std::uint64_t first = begin / kElementPixels, shift = begin % kElementPixels;
  const auto clear = [&](std::uint64_t i, std::uint64_t bits) {
    if ((element(i) & bits) != 0) writable_element(i) &= ~bits;
  };
  for (std::uint64_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0) continue;
    clear(first + i, mask[i] << shift);
    if (shift > 0) clear(first + i + 1, mask[i] >> (kElementPixels - shift));
  }
}

void PixelMask::remove(PixelRange range) {
  for_elements(range, [&](std::uint64_t i, std::uint64_t bits) {
    writable_element(i) &= ~bits;
    return true;
  });
}

ImageMasks MaskMaker::add(std::span<const float> depth) {
  nearest_.resize(depth.size(), image::kEmptyDepth);
  ImageMasks result{PixelMask(depth.size()), PixelMask(depth.size())};
  for (std::size_t begin = 0; begin < depth.size(); begin += kGroupPixels) {
    GroupMask covered{}, unhidden{};
    const std::size_t size = std::min<std::size_t>(kGroupPixels, depth.size() - begin);
    if (internal::find_covered(depth.subspan(begin, size), covered) == 0) continue;
    for (std::size_t i = 0; i < covered.size(); ++i) {
      for (std::uint64_t bits = covered[i]; bits != 0; bits &= bits - 1) {
        const auto bit = static_cast<std::size_t>(std::countr_zero(bits));
        float& nearest = nearest_[begin + i * kElementPixels + bit];
        const float own = depth[begin + i * kElementPixels + bit];
        if (own >= nearest) continue;  // the lower rank wins ties
        nearest = own;
        unhidden[i] |= std::uint64_t{1} << bit;
      }
    }
    result.covered.add(begin, covered);
    result.unhidden.add(begin, unhidden);
  }
  return result;
}

template <class Colour>
ImageMasks MaskMaker::add(const image::BasicImage<Colour>& image, Operator how) {
  if (how == Operator::nearest) return add(image.depth.span());
  const std::span<const Colour> colour = image.colour.span();
  if (!concealed_) concealed_.emplace(colour.size());
  ImageMasks result{PixelMask(colour.size()), PixelMask(colour.size())};
  for (std::size_t begin = 0; begin < colour.size(); begin += kGroupPixels) {
    const std::size_t size = std::min<std::size_t>(kGroupPixels, colour.size() - begin);
    GroupMask covered{}, concealed{}, unhidden{}, opaque{};
    if (how == Operator::over) {
      internal::find_coloured(colour.subspan(begin, size), covered);
    } else {
      internal::find_covered(image.depth.span().subspan(begin, size), covered);
    }
    concealed_->read(begin, begin + size, concealed);
    for (std::size_t i = 0; i < covered.size(); ++i) {
      unhidden[i] = covered[i] & ~concealed[i];
      for (std::uint64_t bits = covered[i]; bits != 0; bits &= bits - 1) {
        const auto bit = static_cast<std::size_t>(std::countr_zero(bits));
        if (internal::hides(colour[begin + i * kElementPixels + bit]))
          opaque[i] |= std::uint64_t{1} << bit;
      }
    }
    result.covered.add(begin, covered);
    result.unhidden.add(begin, unhidden);
    concealed_->add(begin, opaque);
  }
  return result;
}

template ImageMasks MaskMaker::add(const image::Image8& image, Operator how);
template ImageMasks MaskMaker::add(const image::ImageF& image, Operator how);

}  // namespace delray::composite
