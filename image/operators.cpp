// Per-pixel merging in vector registers (Highway): the z-test and the over operator (Porter and
// Duff 1984).
//
// The z-test compares a vector of depths and selects colours by the same mask. In 8 bits the over
// operator multiplies even and odd bytes apart in 16 bits, divides by 255 by shifts, exactly
// rounded, and adds with saturation. The file is compiled for each instruction set; the best that
// the machine has is chosen when the program runs, with the same bytes on all. O(n) at memory
// speed.
//
// Degenerate: equal depths go to the side that the caller names; remainders of a vector are done
// pixel by pixel with equal results.
#include "image/operators.h"

#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/operators.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once for each instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::image {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Merging waits for memory, and vectors beyond 32 bytes make that slower by a tenth (measured on
// Zen 4).
using Depths = hn::CappedTag<float, 8>;

// One pixel, as the vector loops do it; also their remainders.
template <class Colour>
void z_merge_pixel(Colour& colour, float& depth, const Colour& other_colour, float other_depth,
                   bool other_wins_ties) {
  if (other_depth < depth || (other_wins_ties && other_depth == depth)) {
    colour = other_colour;
    depth = other_depth;
  }
}

// Lanes where the other pixel wins.
template <bool kOtherWinsTies, class V>
HWY_INLINE auto other_wins(V other, V own) {
  if constexpr (kOtherWinsTies) {
    return hn::Le(other, own);
  } else {
    return hn::Lt(other, own);
  }
}

// Lines are asked for some 2 KB before they are needed: where images come from memory, merging them
// takes a fifth less time than with what the processor foresees by itself.
HWY_INLINE void fetch_ahead(const void* p) {
  __builtin_prefetch(static_cast<const char*>(p) + 2048);
}

template <bool kOtherWinsTies>
void z_merge_loop(Rgba8* HWY_RESTRICT colour, float* HWY_RESTRICT depth,
                  const Rgba8* HWY_RESTRICT other_colour, const float* HWY_RESTRICT other_depth,
                  std::size_t size) {
  const Depths d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const std::size_t lanes = hn::Lanes(d);
  auto* codes = reinterpret_cast<std::uint32_t*>(colour);
  const auto* other_codes = reinterpret_cast<const std::uint32_t*>(other_colour);
  std::size_t i = 0;
  for (; i + lanes <= size; i += lanes) {
    fetch_ahead(depth + i);
    fetch_ahead(codes + i);
    fetch_ahead(other_depth + i);
    fetch_ahead(other_codes + i);
    const auto own = hn::LoadU(d, depth + i);
    const auto other = hn::LoadU(d, other_depth + i);
    const auto wins = other_wins<kOtherWinsTies>(other, own);
    const auto code = hn::IfThenElse(hn::RebindMask(du, wins), hn::LoadU(du, other_codes + i),
                                     hn::LoadU(du, codes + i));
    hn::StoreU(hn::IfThenElse(wins, other, own), d, depth + i);
    hn::StoreU(code, du, codes + i);
  }
  for (; i < size; ++i) {
    z_merge_pixel(colour[i], depth[i], other_colour[i], other_depth[i], kOtherWinsTies);
  }
}

template <bool kOtherWinsTies>
void z_merge_loop(RgbaF* HWY_RESTRICT colour, float* HWY_RESTRICT depth,
                  const RgbaF* HWY_RESTRICT other_colour, const float* HWY_RESTRICT other_depth,
                  std::size_t size) {
  const Depths d;
  const hn::RebindToSigned<decltype(d)> di;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  if (lanes >= 4) {
    // A vector of depths decides on four vectors of channels; lane k of the part-th of them belongs
    // to depth part * lanes / 4 + k / 4.
    const auto quarter = hn::ShiftRight<2>(hn::Iota(di, 0));
    const auto step = hn::Set(di, static_cast<std::int32_t>(lanes / 4));
    auto* channels = reinterpret_cast<float*>(colour);
    const auto* other_channels = reinterpret_cast<const float*>(other_colour);
    for (; i + lanes <= size; i += lanes) {
      const auto own = hn::LoadU(d, depth + i);
      const auto other = hn::LoadU(d, other_depth + i);
      const auto wins = other_wins<kOtherWinsTies>(other, own);
      const auto winners = hn::VecFromMask(d, wins);
      hn::StoreU(hn::IfThenElse(wins, other, own), d, depth + i);
      auto index = quarter;
      for (std::size_t part = 0; part < 4; ++part) {
        const std::size_t at = 4 * i + part * lanes;
        const auto spread =
            hn::MaskFromVec(hn::TableLookupLanes(winners, hn::IndicesFromVec(d, index)));
        hn::StoreU(
            hn::IfThenElse(spread, hn::LoadU(d, other_channels + at), hn::LoadU(d, channels + at)),
            d, channels + at);
        index = hn::Add(index, step);
      }
    }
  }
  for (; i < size; ++i) {
    z_merge_pixel(colour[i], depth[i], other_colour[i], other_depth[i], kOtherWinsTies);
  }
}

template <class Colour>
void z_merge_any(Colour* colour, float* depth, const Colour* other_colour, const float* other_depth,
                 std::size_t size, Tie tie) {
  if (tie == Tie::other) {
    z_merge_loop<true>(colour, depth, other_colour, other_depth, size);
  } else {
    z_merge_loop<false>(colour, depth, other_colour, other_depth, size);
  }
}

void z_merge_8(Rgba8* colour, float* depth, const Rgba8* other_colour, const float* other_depth,
               std::size_t size, Tie tie) {
  z_merge_any(colour, depth, other_colour, other_depth, size, tie);
}

void z_merge_f(RgbaF* colour, float* depth, const RgbaF* other_colour, const float* other_depth,
               std::size_t size, Tie tie) {
  z_merge_any(colour, depth, other_colour, other_depth, size, tie);
}

// t / 255, rounded to nearest: exact for 0 <= t <= 255 * 255.
template <class V>
HWY_INLINE V divide_by_255(V t) {
  const hn::DFromV<V> d;
  t = hn::Add(t, hn::Set(d, 128));
  return hn::ShiftRight<8>(hn::Add(t, hn::ShiftRight<8>(t)));
}

std::uint8_t over_channel(std::uint8_t front, std::uint8_t back, std::uint8_t front_alpha) {
  const unsigned t = back * (255U - front_alpha) + 128U;
  const unsigned sum = front + ((t + (t >> 8)) >> 8);
  return static_cast<std::uint8_t>(sum < 255U ? sum : 255U);
}

// `result` is `front` or `back`.
void over_8(const Rgba8* front, const Rgba8* back, Rgba8* result, std::size_t size) {
  std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR  // a target of single lanes cannot hold a pixel's bytes
  const hn::ScalableTag<std::uint8_t> d8;
  const hn::Repartition<std::uint16_t, decltype(d8)> d16;
  const hn::Repartition<std::uint32_t, decltype(d8)> d32;
  const std::size_t lanes = hn::Lanes(d32);
  const auto low_byte = hn::Set(d16, 0x00FF);
  for (; i + lanes <= size; i += lanes) {
    const auto f = hn::LoadU(d32, reinterpret_cast<const std::uint32_t*>(front + i));
    const auto b =
        hn::BitCast(d16, hn::LoadU(d32, reinterpret_cast<const std::uint32_t*>(back + i)));
    const auto transparency = hn::Sub(hn::Set(d32, 255), hn::ShiftRight<24>(f));
    const auto factor = hn::BitCast(d16, hn::Or(transparency, hn::ShiftLeft<16>(transparency)));
    const auto even = divide_by_255(hn::Mul(hn::And(b, low_byte), factor));
    const auto odd = divide_by_255(hn::Mul(hn::ShiftRight<8>(b), factor));
    const auto shown = hn::BitCast(d8, hn::Or(even, hn::ShiftLeft<8>(odd)));
    const auto sum = hn::SaturatedAdd(hn::BitCast(d8, f), shown);
    hn::StoreU(hn::BitCast(d32, sum), d32, reinterpret_cast<std::uint32_t*>(result + i));
  }
#endif
  for (; i < size; ++i) {
    const Rgba8 f = front[i], b = back[i];
    result[i] = {over_channel(f.r, b.r, f.a), over_channel(f.g, b.g, f.a),
                 over_channel(f.b, b.b, f.a), over_channel(f.a, b.a, f.a)};
  }
}

// `result` is `front` or `back`.
void over_f(const RgbaF* front, const RgbaF* back, RgbaF* result, std::size_t size) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  if (lanes >= 4) {
    const auto one = hn::Set(d, 1.0F);
    const auto alpha = hn::IndicesFromVec(d, hn::Or(hn::Iota(hn::RebindToSigned<decltype(d)>(), 0),
                                                    hn::Set(hn::RebindToSigned<decltype(d)>(), 3)));
    const std::size_t pixels = lanes / 4;
    for (; i + pixels <= size; i += pixels) {
      const auto f = hn::LoadU(d, reinterpret_cast<const float*>(front + i));
      const auto b = hn::LoadU(d, reinterpret_cast<const float*>(back + i));
      const auto transparency = hn::Sub(one, hn::TableLookupLanes(f, alpha));
      hn::StoreU(hn::Add(f, hn::Mul(b, transparency)), d, reinterpret_cast<float*>(result + i));
    }
  }
  for (; i < size; ++i) {
    const RgbaF f = front[i], b = back[i];
    const float transparency = 1.0F - f.a;
    result[i] = {f.r + b.r * transparency, f.g + b.g * transparency, f.b + b.b * transparency,
                 f.a + b.a * transparency};
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace delray::image
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::image {

HWY_EXPORT(z_merge_8);
HWY_EXPORT(z_merge_f);
HWY_EXPORT(over_8);
HWY_EXPORT(over_f);

void z_merge(std::span<Rgba8> colour, std::span<float> depth, std::span<const Rgba8> other_colour,
             std::span<const float> other_depth, Tie tie) {
  assert(depth.size() == colour.size() && other_colour.size() == colour.size() &&
         other_depth.size() == colour.size());
  HWY_DYNAMIC_DISPATCH(z_merge_8)
  (colour.data(), depth.data(), other_colour.data(), other_depth.data(), colour.size(), tie);
}

void z_merge(std::span<RgbaF> colour, std::span<float> depth, std::span<const RgbaF> other_colour,
             std::span<const float> other_depth, Tie tie) {
  assert(depth.size() == colour.size() && other_colour.size() == colour.size() &&
         other_depth.size() == colour.size());
  HWY_DYNAMIC_DISPATCH(z_merge_f)
  (colour.data(), depth.data(), other_colour.data(), other_depth.data(), colour.size(), tie);
}

void blend_front(std::span<Rgba8> target, std::span<const Rgba8> front) {
  assert(front.size() == target.size());
  HWY_DYNAMIC_DISPATCH(over_8)(front.data(), target.data(), target.data(), target.size());
}

void blend_front(std::span<RgbaF> target, std::span<const RgbaF> front) {
  assert(front.size() == target.size());
  HWY_DYNAMIC_DISPATCH(over_f)(front.data(), target.data(), target.data(), target.size());
}

void blend_back(std::span<Rgba8> target, std::span<const Rgba8> back) {
  assert(back.size() == target.size());
  HWY_DYNAMIC_DISPATCH(over_8)(target.data(), back.data(), target.data(), target.size());
}

void blend_back(std::span<RgbaF> target, std::span<const RgbaF> back) {
  assert(back.size() == target.size());
  HWY_DYNAMIC_DISPATCH(over_f)(target.data(), back.data(), target.data(), target.size());
}

}  // namespace delray::image
#endif  // HWY_ONCE
