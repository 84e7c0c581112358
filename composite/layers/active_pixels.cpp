// Compresses, expands and merges the covered pixels of a group, by the bits of a mask.
//
// A mask is read a vector's worth of bits at a time. Compressing stores the lanes that are set next
// to each other; expanding takes each set lane's value from the lane that a table gives for the
// bits, without a branch, as scattered pixels cannot be predicted. Elements of 64 pixels that are
// all covered are taken as they are. O(pixels of the group).
//
// Colours of four floats go one by one. Degenerate: compressed values are never read beyond those
// that are readable, though vectors are wider; those of all pixels of a group are, by less than
// one.
#include "composite/layers/active_pixels.h"

#include <array>
#include <bit>
#include <cassert>
#include <cstring>

#include <hwy/cache_control.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "composite/layers/active_pixels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once for each instruction set.
#include <hwy/highway.h>

#ifndef DELRAY_COMPOSITE_ACTIVE_PIXELS
#define DELRAY_COMPOSITE_ACTIVE_PIXELS
namespace delray::composite::internal {

// Element j of row b: how many of the bits below j are set in b. The values of covered pixels, one
// after the other, get to their lanes by it.
using ExpandTable = std::array<std::array<std::uint8_t, kMostLanes>, 256>;
constexpr ExpandTable make_expand_table() {
  ExpandTable table{};
  for (unsigned bits = 0; bits < table.size(); ++bits) {
    for (unsigned j = 0; j < kMostLanes; ++j) {
      table[bits][j] = static_cast<std::uint8_t>(std::popcount(bits & ((1U << j) - 1)));
    }
  }
  return table;
}
inline constexpr ExpandTable kExpand = make_expand_table();

}  // namespace delray::composite::internal
#endif

HWY_BEFORE_NAMESPACE();
namespace delray::composite::internal {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Rows of kExpand are for no more than 8 lanes.
using Depths = hn::CappedTag<float, kMostLanes>;
using Codes = hn::RebindToUnsigned<Depths>;
constexpr std::uint64_t kAll = ~std::uint64_t{0};

// Runs of covered pixels are too short for the processor to notice that they will be read.
constexpr std::size_t kElementsAhead = 4, kElements = std::tuple_size_v<GroupMask>;
template <class T>
HWY_INLINE void prefetch_element(const T* values) {
  constexpr std::size_t kLine = 64 / sizeof(T);
  for (std::size_t i = 0; i < 64; i += kLine) hwy::Prefetch(values + i);
}

// Pixels that `is_covered` says are: of vectors of values, and of single ones.
template <class D, class T, class F>
HWY_INLINE std::uint64_t find_loop(D d, const T* values, std::size_t size, std::uint64_t* mask,
                                   F&& is_covered) {
  const std::size_t lanes = hn::Lanes(d);
  const hn::CappedTag<T, 1> one;
  std::uint64_t covered = 0;
  std::size_t i = 0;
  for (; i + 64 <= size; i += 64) {
    std::uint64_t bits = 0;
    for (std::size_t j = 0; j < 64; j += lanes) {
      std::uint8_t some[8] = {};
      hn::StoreMaskBits(d, is_covered(d, hn::LoadU(d, values + i + j)), some);
      bits |= std::uint64_t{some[0]} << j;
    }
    mask[i / 64] = bits;
    covered += static_cast<std::uint64_t>(std::popcount(bits));
  }
  for (; i < size; ++i) {
    const std::uint64_t bit = hn::CountTrue(one, is_covered(one, hn::LoadU(one, values + i)));
    mask[i / 64] |= bit << i % 64;
    covered += bit;
  }
  return covered;
}

std::uint64_t find_covered_loop(const float* depth, std::size_t size, std::uint64_t* mask) {
  return find_loop(Depths(), depth, size, mask, [](auto d, auto values) HWY_ATTR {
    return hn::Ne(values, hn::Set(d, image::kEmptyDepth));
  });
}

std::uint64_t find_nearer_loop(const float* depths, float depth, std::size_t size,
                               std::uint64_t* mask) {
  return find_loop(Depths(), depths, size, mask, [depth](auto d, auto values) HWY_ATTR {
    return hn::Lt(values, hn::Set(d, depth));
  });
}

// Pixels with any of these bits.
std::uint64_t find_bits_loop(const std::uint32_t* colour, std::uint32_t bits, std::size_t size,
                             std::uint64_t* mask) {
  return find_loop(Codes(), colour, size, mask, [bits](auto d, auto values) HWY_ATTR {
    return hn::Ne(hn::And(values, hn::Set(d, bits)), hn::Zero(d));
  });
}

void compress_loop(const std::uint32_t* values, const std::uint64_t* mask, std::uint32_t* to,
                   const std::uint32_t* end) {
  const Codes d;
  const std::size_t lanes = hn::Lanes(d);
  const std::uint64_t lane_bits = (std::uint64_t{1} << lanes) - 1;
  for (std::size_t i = 0; to < end; ++i) {
    if (i + kElementsAhead < kElements && mask[i + kElementsAhead] != 0) {
      prefetch_element(values + (i + kElementsAhead) * 64);
    }
    const std::uint64_t bits = mask[i];
    const std::uint32_t* from = values + i * 64;
    if (bits == kAll) {
      std::memcpy(to, from, 64 * sizeof *to);
      to += 64;
      continue;
    }
    for (std::uint64_t rest = bits; rest != 0; rest = lanes < 64 ? rest >> lanes : 0) {
      // No branch for lanes that none are of: with scattered pixels nobody could foretell it.
      const auto some = static_cast<std::uint8_t>(rest & lane_bits);
      std::uint8_t loaded[8] = {some};
      const auto packed = hn::Compress(hn::LoadU(d, from), hn::LoadMaskBits(d, loaded));
      const auto count = static_cast<std::size_t>(std::popcount(some));
      if (to + lanes <= end) {
        hn::StoreU(packed, d, to);
      } else {
        HWY_ALIGN std::uint32_t last[kMostLanes];
        hn::Store(packed, d, last);
        std::memcpy(to, last, count * sizeof *to);
      }
      to += count;
      from += lanes;
    }
  }
}

// The next `lanes` values, or fewer and something else at the end of what is readable.
template <class D, class T>
HWY_INLINE auto load_some(D d, const T* from, bool at_end, std::size_t count) {
  if (HWY_UNLIKELY(at_end)) {
    HWY_ALIGN T last[kMostLanes] = {};
    std::memcpy(last, from, count * sizeof(T));
    return hn::Load(d, last);
  }
  return hn::LoadU(d, from);
}

template <bool kOtherWinsTies, class V>
HWY_INLINE auto other_wins(V other, V own) {
  if constexpr (kOtherWinsTies) {
    return hn::Le(other, own);
  } else {
    return hn::Lt(other, own);
  }
}

template <bool kOtherWinsTies>
void z_merge_loop(std::uint32_t* HWY_RESTRICT colour, float* HWY_RESTRICT depth,
                  const std::uint64_t* HWY_RESTRICT mask, std::size_t elements,
                  const std::uint32_t* HWY_RESTRICT other_colour,
                  const float* HWY_RESTRICT other_depth, std::size_t readable) {
  const Depths d;
  const Codes du;
  const hn::RebindToSigned<Depths> di;
  const hn::Rebind<std::uint8_t, Depths> d8;
  const std::size_t lanes = hn::Lanes(d);
  const std::uint64_t lane_bits = (std::uint64_t{1} << lanes) - 1;
  const auto merge = [&](std::size_t at, auto received, auto other, auto code) HWY_ATTR {
    const auto own = hn::LoadU(d, depth + at);
    const auto wins = hn::And(received, other_wins<kOtherWinsTies>(other, own));
    hn::StoreU(hn::IfThenElse(wins, other, own), d, depth + at);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(du, wins), code, hn::LoadU(du, colour + at)), du,
               colour + at);
  };
  const auto everything = hn::Eq(hn::Zero(d), hn::Zero(d));
  std::size_t next = 0;
  for (std::size_t i = 0; i < elements; ++i) {
    if (i + kElementsAhead < elements && mask[i + kElementsAhead] != 0) {
      prefetch_element(depth + (i + kElementsAhead) * 64);
      prefetch_element(colour + (i + kElementsAhead) * 64);
    }
    const std::uint64_t bits = mask[i];
    std::size_t at = i * 64;
    if (bits == kAll) {
      for (std::size_t j = 0; j < 64; j += lanes) {
        merge(at + j, everything, hn::LoadU(d, other_depth + next + j),
              hn::LoadU(du, other_colour + next + j));
      }
      next += 64;
      continue;
    }
    for (std::uint64_t rest = bits; rest != 0; rest >>= lanes, at += lanes) {
      const auto some = static_cast<std::uint8_t>(rest & lane_bits);
      const auto count = static_cast<std::size_t>(std::popcount(some));
      const bool at_end = next + lanes > readable;
      auto other = load_some(d, other_depth + next, at_end, count);
      auto code = load_some(du, other_colour + next, at_end, count);
      if (lanes > 1) {
        const auto index =
            hn::IndicesFromVec(d, hn::PromoteTo(di, hn::LoadU(d8, kExpand[some].data())));
        other = hn::TableLookupLanes(other, index);
        code = hn::BitCast(du, hn::TableLookupLanes(hn::BitCast(d, code), index));
      }
      std::uint8_t loaded[8] = {some};
      merge(at, hn::LoadMaskBits(d, loaded), other, code);
      next += count;
    }
  }
}

// The inverse of compress: pixels that are not covered get `nothing`.
void expand_loop(const std::uint32_t* values, std::size_t readable, const std::uint64_t* mask,
                 std::size_t elements, std::uint32_t nothing, std::uint32_t* HWY_RESTRICT to) {
  const Codes d;
  const hn::RebindToSigned<Depths> di;
  const hn::Rebind<std::uint8_t, Depths> d8;
  const std::size_t lanes = hn::Lanes(d);
  const std::uint64_t lane_bits = (std::uint64_t{1} << lanes) - 1;
  const auto empty = hn::Set(d, nothing);
  std::size_t next = 0;
  for (std::size_t i = 0; i < elements; ++i, to += 64) {
    if (mask[i] == 0) {
      std::fill_n(to, 64, nothing);
      continue;
    }
    if (mask[i] == kAll) {
      std::memcpy(to, values + next, 64 * sizeof *to);
      next += 64;
      continue;
    }
    std::uint64_t rest = mask[i];
    for (std::size_t j = 0; j < 64; j += lanes, rest >>= lanes) {
      const auto some = static_cast<std::uint8_t>(rest & lane_bits);
      const auto count = static_cast<std::size_t>(std::popcount(some));
      auto code = load_some(d, values + next, next + lanes > readable, count);
      if (lanes > 1) {
        code = hn::TableLookupLanes(
            code, hn::IndicesFromVec(d, hn::PromoteTo(di, hn::LoadU(d8, kExpand[some].data()))));
      }
      std::uint8_t loaded[8] = {some};
      hn::StoreU(hn::IfThenElse(hn::LoadMaskBits(d, loaded), code, empty), d, to + j);
      next += count;
    }
  }
}

void z_merge_any(std::uint32_t* colour, float* depth, const std::uint64_t* mask,
                 std::size_t elements, const std::uint32_t* other_colour, const float* other_depth,
                 std::size_t readable, image::Tie tie) {
  if (tie == image::Tie::other) {
    z_merge_loop<true>(colour, depth, mask, elements, other_colour, other_depth, readable);
  } else {
    z_merge_loop<false>(colour, depth, mask, elements, other_colour, other_depth, readable);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace delray::composite::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::composite::internal {

HWY_EXPORT(find_covered_loop);
HWY_EXPORT(find_nearer_loop);
HWY_EXPORT(find_bits_loop);
HWY_EXPORT(expand_loop);
HWY_EXPORT(compress_loop);
HWY_EXPORT(z_merge_any);

std::uint64_t find_covered(std::span<const float> depth, GroupMask& mask) {
  assert(depth.size() <= kGroupPixels);
  return HWY_DYNAMIC_DISPATCH(find_covered_loop)(depth.data(), depth.size(), mask.data());
}

std::uint64_t find_nearer(std::span<const float> depths, float depth, GroupMask& mask) {
  assert(depths.size() <= kGroupPixels);
  return HWY_DYNAMIC_DISPATCH(find_nearer_loop)(depths.data(), depth, depths.size(), mask.data());
}

std::uint64_t find_with_bits(std::span<const image::Rgba8> colour, image::Rgba8 bits,
                             GroupMask& mask) {
  assert(colour.size() <= kGroupPixels);
  return HWY_DYNAMIC_DISPATCH(find_bits_loop)(reinterpret_cast<const std::uint32_t*>(colour.data()),
                                              std::bit_cast<std::uint32_t>(bits), colour.size(),
                                              mask.data());
}

std::uint64_t find_coloured(std::span<const image::Rgba8> colour, GroupMask& mask) {
  return find_with_bits(colour, {255, 255, 255, 255}, mask);
}

std::uint64_t find_with_alpha(std::span<const image::Rgba8> colour, GroupMask& mask) {
  return find_with_bits(colour, {0, 0, 0, 255}, mask);
}

std::uint64_t find_with_alpha(std::span<const image::RgbaF> colour, GroupMask& mask) {
  std::uint64_t covered = 0;
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const std::uint64_t bit = colour[i].a == 0 ? 0 : 1;
    mask[i / 64] |= bit << i % 64;
    covered += bit;
  }
  return covered;
}

std::uint64_t find_coloured(std::span<const image::RgbaF> colour, GroupMask& mask) {
  std::uint64_t covered = 0;
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const std::uint64_t bit = colour[i] == image::RgbaF{} ? 0 : 1;
    mask[i / 64] |= bit << i % 64;
    covered += bit;
  }
  return covered;
}

void compress(const std::uint32_t* values, const GroupMask& mask, std::span<std::uint32_t> to) {
  HWY_DYNAMIC_DISPATCH(compress_loop)(values, mask.data(), to.data(), to.data() + to.size());
}

void expand(const std::uint32_t* values, std::size_t readable, const GroupMask& mask,
            std::uint32_t nothing, std::span<std::uint32_t> to) {
  const std::size_t elements = to.size() / 64, rest = to.size() % 64;
  HWY_DYNAMIC_DISPATCH(expand_loop)
  (values, readable, mask.data(), elements, nothing, to.data());
  if (rest == 0) return;
  std::size_t before = 0;
  for (std::size_t i = 0; i < elements; ++i) {
    before += static_cast<std::size_t>(std::popcount(mask[i]));
  }
  std::array<std::uint32_t, 64> last;
  HWY_DYNAMIC_DISPATCH(expand_loop)
  (values + before, readable - before, mask.data() + elements, 1, nothing, last.data());
  std::copy_n(last.begin(), rest, to.begin() + static_cast<std::ptrdiff_t>(elements * 64));
}

void expand(const image::Rgba8* values, std::size_t readable, const GroupMask& mask,
            image::Rgba8 nothing, std::span<image::Rgba8> to) {
  expand(reinterpret_cast<const std::uint32_t*>(values), readable, mask,
         std::bit_cast<std::uint32_t>(nothing),
         {reinterpret_cast<std::uint32_t*>(to.data()), to.size()});
}

void expand(const float* values, std::size_t readable, const GroupMask& mask, std::span<float> to) {
  expand(reinterpret_cast<const std::uint32_t*>(values), readable, mask,
         std::bit_cast<std::uint32_t>(image::kEmptyDepth),
         {reinterpret_cast<std::uint32_t*>(to.data()), to.size()});
}

void expand(const image::RgbaF* values, std::size_t /*readable*/, const GroupMask& mask,
            image::RgbaF nothing, std::span<image::RgbaF> to) {
  std::fill(to.begin(), to.end(), nothing);
  for (std::size_t i = 0; i * 64 < to.size(); ++i) {
    for (std::uint64_t bits = mask[i]; bits != 0; bits &= bits - 1) {
      to[i * 64 + static_cast<std::size_t>(std::countr_zero(bits))] = *values++;
    }
  }
}

void compress(const image::Rgba8* values, const GroupMask& mask, std::span<image::Rgba8> to) {
  compress(reinterpret_cast<const std::uint32_t*>(values), mask,
           {reinterpret_cast<std::uint32_t*>(to.data()), to.size()});
}

void compress(const float* values, const GroupMask& mask, std::span<float> to) {
  compress(reinterpret_cast<const std::uint32_t*>(values), mask,
           {reinterpret_cast<std::uint32_t*>(to.data()), to.size()});
}

void compress(const image::RgbaF* values, const GroupMask& mask, std::span<image::RgbaF> to) {
  image::RgbaF* next = to.data();
  for (std::size_t i = 0; i < mask.size(); ++i) {
    for (std::uint64_t bits = mask[i]; bits != 0; bits &= bits - 1) {
      *next++ = values[i * 64 + static_cast<std::size_t>(std::countr_zero(bits))];
    }
  }
  assert(next == to.data() + to.size());
}

void z_merge(image::Rgba8* colour, float* depth, const GroupMask& mask,
             const ActivePixels<image::Rgba8>& other, image::Tie tie) {
  HWY_DYNAMIC_DISPATCH(z_merge_any)
  (reinterpret_cast<std::uint32_t*>(colour), depth, mask.data(), mask.size(),
   reinterpret_cast<const std::uint32_t*>(other.colour), other.depth, other.readable, tie);
}

void z_merge(image::RgbaF* colour, float* depth, const GroupMask& mask,
             const ActivePixels<image::RgbaF>& other, image::Tie tie) {
  std::size_t k = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == ~std::uint64_t{0}) {
      image::z_merge(std::span(colour + i * 64, 64), std::span(depth + i * 64, 64),
                     std::span(other.colour + k, 64), std::span(other.depth + k, 64), tie);
      k += 64;
      continue;
    }
    for (std::uint64_t bits = mask[i]; bits != 0; bits &= bits - 1, ++k) {
      const std::size_t at = i * 64 + static_cast<std::size_t>(std::countr_zero(bits));
      if (other.depth[k] < depth[at] || (tie == image::Tie::other && other.depth[k] == depth[at])) {
        colour[at] = other.colour[k];
        depth[at] = other.depth[k];
      }
    }
  }
}

void blend(image::Rgba8* colour, std::size_t size, const GroupMask& mask,
           const ActivePixels<image::Rgba8>& other, bool front) {
  const std::size_t elements = (size + 63) / 64;
  std::array<image::Rgba8, kGroupPixels> expanded;
  for (std::size_t i = 0, next = 0; i < elements;) {
    // Elements of one kind: pixels that are not covered have no effect, and those that all are
    // need not be expanded.
    const auto kind = [&](std::size_t k) { return mask[k] == 0 ? 0 : ~mask[k] == 0 ? 2 : 1; };
    const std::size_t first = i;
    std::size_t covered = 0;
    for (; i < elements && kind(i) == kind(first); ++i) {
      covered += static_cast<std::size_t>(std::popcount(mask[i]));
    }
    if (covered == 0) continue;
    const std::size_t count = std::min(i * 64, size) - first * 64;
    std::span<const image::Rgba8> layer(other.colour + next, covered);
    if (covered < count) {
      GroupMask some{};
      std::copy(mask.begin() + first, mask.begin() + i, some.begin());
      expand(other.colour + next, other.readable - next, some, {},
             std::span(expanded.data(), count));
      layer = {expanded.data(), count};
    }
    const std::span target(colour + first * 64, count);
    front ? image::blend_front(target, layer) : image::blend_back(target, layer);
    next += covered;
  }
}

void blend(image::RgbaF* colour, std::size_t size, const GroupMask& mask,
           const ActivePixels<image::RgbaF>& other, bool front) {
  std::size_t k = 0;
  for (std::size_t i = 0; i * 64 < size; ++i) {
    std::array<image::RgbaF, 64> expanded{};
    if (mask[i] == 0) continue;
    for (std::uint64_t bits = mask[i]; bits != 0; bits &= bits - 1) {
      expanded[static_cast<std::size_t>(std::countr_zero(bits))] = other.colour[k++];
    }
    const std::size_t count = std::min<std::size_t>(64, size - i * 64);
    const std::span<const image::RgbaF> layer(expanded.data(), count);
    const std::span target(colour + i * 64, count);
    front ? image::blend_front(target, layer) : image::blend_back(target, layer);
  }
}

}  // namespace delray::composite::internal
#endif  // HWY_ONCE
