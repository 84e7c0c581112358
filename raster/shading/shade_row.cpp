// Evaluates planes of colours along a row, encodes them and stores them, by vectors.
//
// Long runs of one triangle go by vectors of pixels. Rows of many short runs go by vectors of a
// pixel's four values, which are transposed before they are divided. 8-bit sRGB is looked up, or
// where vectors are long computed by a polynomial and looked up only where rounding might decide:
// both give image::encode_srgb exactly.
//
// Degenerate: pixels that show nothing become transparent black.
#include "raster/shading/shade_row.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "image/srgb.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/shading/shade_row.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

#include "raster/shading/transpose.h"

#ifndef DELRAY_RASTER_SHADE_ROW
#define DELRAY_RASTER_SHADE_ROW
namespace delray::raster {

// image::encode_srgb in one look-up: element i has, of bucket i, the code of its least float and,
// shifted by 8, the lower half of the bits of the float at which the next code begins; 2^16 where
// none does.
inline constexpr std::size_t kSrgbBuckets = image::internal::kBuckets;
constexpr std::array<std::int32_t, kSrgbBuckets> make_srgb_steps() {
  std::array<std::int32_t, kSrgbBuckets> table{};
  for (std::size_t i = 0; i < kSrgbBuckets; ++i) {
    const std::int32_t code = image::internal::kCodeOfBucket[i];
    const std::uint32_t bucket = image::internal::kFirstBits +
                                 static_cast<std::uint32_t>(i << image::internal::kBucketShift);
    const auto next = std::bit_cast<std::uint32_t>(
        image::internal::kLeastOfCode[static_cast<std::size_t>(code) + 1]);
    const bool within = next >> 16 == bucket >> 16;
    table[i] = code | (within ? static_cast<std::int32_t>(next & 0xFFFF) : 0x10000) << 8;
  }
  return table;
}
static_assert(image::internal::kBucketShift == 16);
inline constexpr std::array<std::int32_t, kSrgbBuckets> kSrgbSteps = make_srgb_steps();

// Codes above 10 are 269.025 x^(5/12) - 14.025 of linear light x (IEC 61966-2-1). x is 2^e m with m
// from 1 to 2: element (e + 127) % 16 of the first table is 269.025 * 2^(5 e / 12), -9 <= e <= 0,
// the other are the coefficients of a polynomial for m^(5/12), relative error 1.2e-6.
alignas(64) inline constexpr float kPowerOfExponent[16] = {
    0,           0,           0,           0,           0,           0,
    19.9954028F, 26.6906605F, 35.6277574F, 47.5573505F, 63.4814467F, 84.7375651F,
    113.111079F, 150.985177F, 201.541031F, 269.025F};
inline constexpr float kPower[6] = {0.376330309F, 0.952814901F,   -0.491730163F,
                                    0.208567785F, -0.0514170146F, 0.00543537306F};
// Of codes that are computed with it: 3.3e-4 for the polynomial and less than 2e-4 for rounding.
inline constexpr float kCodeError = 6e-4F;

// Where pixels are after a vector's worth of them was transposed block by block: block k of four
// lanes has pixels k, k + blocks, k + 2 blocks and k + 3 blocks.
constexpr std::array<std::int32_t, kBlockSize> lanes_after_transposing(std::size_t lanes) {
  std::array<std::int32_t, kBlockSize> result{};
  const std::size_t blocks = lanes / 4;
  for (std::size_t i = 0; i < lanes && blocks > 0; ++i)
    result[i] = static_cast<std::int32_t>(4 * (i % blocks) + i / blocks);
  return result;
}

// Runs of which there are fewer in a row are long: they are shaded by vectors of pixels, others by
// vectors of a pixel's values.
inline constexpr int kManyRuns = 8;

}  // namespace delray::raster
#endif

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = HWY_CAPPED(float, kBlockSize);
using Ints = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;
using I = hn::Vec<Ints>;

struct Colours {
  F red, green, blue;
};

// The planes of a triangle at pixels (x, y): the arithmetic of value_at.
HWY_INLINE FourVectors<F> sums_of(const PixelTriangle& t, F x, float y) {
  const Floats d;
  const F dx = hn::Sub(x, hn::Set(d, t.x));
  const float dy = y - t.y;
  FourVectors<F> sums;
  for (int k = 0; k < 4; ++k)
    sums.v[k] = hn::Add(hn::Mul(hn::Set(d, t.a[k]), dx), hn::Set(d, t.b[k] * dy + t.c[k]));
  return sums;
}

HWY_INLINE Colours divided(const FourVectors<F>& sums) {
  const F share = hn::Div(hn::Set(Floats(), 1.0F), sums.v[3]);
  return {hn::Mul(sums.v[0], share), hn::Mul(sums.v[1], share), hn::Mul(sums.v[2], share)};
}

#if HWY_TARGET != HWY_SCALAR
// The four sums of each pixel of a row, pixel after pixel.
struct RowSums {
  static constexpr int kRoom = kTileSize + kBlockSize;
  alignas(64) float of[kRoom][4];
};

// Of pixels [first, last) of the row, the first of which is at `column`; some after them may be
// changed.
HWY_INLINE void sums_of_run(const PixelTriangle& t, float column, float y, int first, int last,
                            RowSums& sums) {
  constexpr int kAtOnce = 4;  // pixels: most runs have no more
  const Floats d;
  const HWY_CAPPED(float, 4) four;
  constexpr int kPixels = static_cast<int>(hn::MaxLanes(Floats())) / 4;
  const auto dy = hn::Set(four, y - t.y);
  HWY_ALIGN float row_sums[4];
  hn::Store(hn::Add(hn::Mul(hn::Load(four, t.b), dy), hn::Load(four, t.c)), four, row_sums);
  const F a = hn::LoadDup128(d, t.a), rest = hn::LoadDup128(d, row_sums);
  const F pixel = hn::ConvertTo(d, hn::ShiftRight<2>(hn::Iota(Ints(), 0)));
  float at = column - t.x;
  for (int i = first; i < last; i += kAtOnce) {
    for (int k = 0; k < kAtOnce; k += kPixels, at += static_cast<float>(kPixels)) {
      const F dx = hn::Add(hn::Set(d, at), pixel);  // whole numbers: exact
      hn::StoreU(hn::Add(hn::Mul(a, dx), rest), d, sums.of[i + k]);
    }
  }
}
#endif

// image::encode_srgb, by table.
HWY_INLINE I looked_up_code(F linear) {
  const Floats d;
  const Ints di;
  const F least = hn::Set(d, 0x1p-13F);
  const auto dark = hn::Not(hn::Ge(linear, least));
  const auto bright = hn::Ge(linear, hn::Set(d, 1.0F));
  const F within = hn::IfThenElse(hn::Or(dark, bright), least, linear);
  const I bits = hn::BitCast(di, within);
  const I offset =
      hn::Sub(bits, hn::Set(di, static_cast<std::int32_t>(image::internal::kFirstBits)));
  const I step = hn::GatherIndex(di, kSrgbSteps.data(), hn::ShiftRight<16>(offset));
  const I lower = hn::And(bits, hn::Set(di, 0xFFFF));
  // A mask is -1 where it is true.
  const auto reached = hn::Gt(hn::ShiftRight<8>(step), lower);
  const I code = hn::Add(hn::And(step, hn::Set(di, 0xFF)),
                         hn::IfThenElse(reached, hn::Zero(di), hn::Set(di, 1)));
  const I bounded = hn::IfThenElse(hn::RebindMask(di, bright), hn::Set(di, 255), code);
  return hn::IfThenElse(hn::RebindMask(di, dark), hn::Zero(di), bounded);
}

// A code before it is rounded, within kCodeError. What is below 0 counts as 0, what is above 1 as
// 1; of what is not a number it is that of 0, or not a number.
HWY_INLINE F estimated_code(F linear) {
  const Floats d;
  const Ints di;
  const F x = hn::Min(hn::Max(linear, hn::Zero(d)), hn::Set(d, 1.0F));
  const I bits = hn::BitCast(di, x);
  const I exponent = hn::And(hn::ShiftRight<23>(bits), hn::Set(di, 15));
  const F scale =
      hn::TableLookupLanes(hn::Load(d, kPowerOfExponent), hn::IndicesFromVec(d, exponent));
  const F m = hn::BitCast(
      d, hn::Or(hn::And(bits, hn::Set(di, 0x7FFFFF)), hn::BitCast(di, hn::Set(d, 1.0F))));
  F power = hn::Set(d, kPower[5]);
  for (int k = 4; k >= 0; --k) power = hn::MulAdd(power, m, hn::Set(d, kPower[k]));
  const F curve = hn::MulAdd(scale, power, hn::Set(d, -0.055F * 255));
  const auto dark = hn::Lt(x, hn::Set(d, 0.0031308F));
  if (HWY_LIKELY(hn::AllFalse(d, dark))) return curve;
  return hn::IfThenElse(dark, hn::Mul(x, hn::Set(d, 12.92F * 255)), curve);
}

// In the lowest byte; the two above it are 0.
struct Codes {
  I red, green, blue;
};
// image::encode_srgb of each. Where vectors are long, gathering takes longer than to compute the
// code, which is certain unless it is close to the next one; the result does not tell.
HWY_INLINE Codes encoded(const Colours& colours) {
  const Floats d;
  if constexpr (hn::MaxLanes(Floats()) == kBlockSize) {
    const Ints di;
    // Added to a small number, leaves its nearest whole number in the lower bits.
    const F rounder = hn::Set(d, 0x1p23F);
    const F value[3] = {estimated_code(colours.red), estimated_code(colours.green),
                        estimated_code(colours.blue)};
    F rounded[3], off[3];
    for (int k = 0; k < 3; ++k) {
      rounded[k] = hn::Add(value[k], rounder);
      off[k] = hn::Abs(hn::Sub(value[k], hn::Sub(rounded[k], rounder)));
    }
    const F farthest = hn::Max(hn::Max(off[0], off[1]), off[2]);
    if (HWY_LIKELY(hn::AllTrue(d, hn::Lt(farthest, hn::Set(d, 0.5F - kCodeError))))) {
      return {hn::BitCast(di, rounded[0]), hn::BitCast(di, rounded[1]),
              hn::BitCast(di, rounded[2])};
    }
  }
  return {looked_up_code(colours.red), looked_up_code(colours.green), looked_up_code(colours.blue)};
}

struct InOrder {
  template <class V>
  V operator()(V v) const {
    return v;
  }
};

// Lane i of order(vector) is pixel i.
template <class Order = InOrder>
HWY_INLINE void store(const Colours& colours, hn::Mask<Ints> shown, image::Rgba8* pixels,
                      const Order& order = {}) {
  const Ints d;
  const Codes codes = encoded(colours);
  const I code = hn::Or(
      hn::Or(codes.red, hn::ShiftLeft<8>(codes.green)),
      hn::Or(hn::ShiftLeft<16>(codes.blue), hn::Set(d, static_cast<std::int32_t>(0xFF000000U))));
  hn::StoreU(hn::IfThenElseZero(shown, order(code)), d, reinterpret_cast<std::int32_t*>(pixels));
}
template <class Order = InOrder>
HWY_INLINE void store(const Colours& in_lanes, hn::Mask<Ints> shown, image::RgbaF* pixels,
                      const Order& order = {}) {
  const Colours colours = {order(in_lanes.red), order(in_lanes.green), order(in_lanes.blue)};
  const Floats d;
  const auto mask = hn::RebindMask(d, shown);
  hn::StoreInterleaved4(
      hn::IfThenElseZero(mask, colours.red), hn::IfThenElseZero(mask, colours.green),
      hn::IfThenElseZero(mask, colours.blue), hn::IfThenElseZero(mask, hn::Set(d, 1.0F)), d,
      reinterpret_cast<float*>(pixels));
}

HWY_INLINE hn::Mask<Ints> mask_of(std::uint32_t bits) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits),
                                 static_cast<std::uint8_t>(bits >> 8)};
  return hn::LoadMaskBits(Ints(), bytes);
}

// By vectors of pixels.
template <class Colour>
HWY_INLINE void shade_long_runs(const PixelTriangle* triangles, const TriangleIndices& indices,
                                const RowRuns& runs, int x, int y, int count, Colour* pixels) {
  const Floats d;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const std::uint32_t all = (std::uint32_t{1} << lanes) - 1;
  // A constant; counted from a variable, lanes are filled one by one.
  const I lane_numbers = hn::Iota(di, 0);
  const auto row = static_cast<float>(y);
  for (int i = 0; i < count; i += lanes) {
    const std::uint32_t shown = static_cast<std::uint32_t>(runs.shown >> i) & all;
    if (shown == 0) {
      std::fill_n(pixels + i, lanes, Colour());
      continue;
    }
    const F column = hn::ConvertTo(d, hn::Add(hn::Set(di, x + i), lane_numbers));
    const auto sums_at = [&](int k) HWY_ATTR {
      return sums_of(triangles[indices.of(runs.numbers[i + k])], column, row);
    };
    const int first = std::countr_zero(shown);
    FourVectors<F> sums = sums_at(first);
    std::uint32_t changes = static_cast<std::uint32_t>(runs.starts >> i) & shown;
    changes &= ~((std::uint32_t{2} << first) - 1);
    for (; changes != 0; changes &= changes - 1) {
      const int k = std::countr_zero(changes);
      const auto mask = hn::RebindMask(d, mask_of(all << k & all));
      const FourVectors<F> others = sums_at(k);
      for (int v = 0; v < 4; ++v) sums.v[v] = hn::IfThenElse(mask, others.v[v], sums.v[v]);
    }
    store(divided(sums), mask_of(shown), pixels + i);
  }
}

#if HWY_TARGET != HWY_SCALAR
// By vectors of a pixel's values, and then by vectors of pixels.
template <class Colour>
HWY_INLINE void shade_short_runs(const PixelTriangle* triangles, const TriangleIndices& indices,
                                 const RowRuns& runs, int x, int y, int count, Colour* pixels) {
  const Floats d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const std::uint32_t all = (std::uint32_t{1} << lanes) - 1;
  const auto row = static_cast<float>(y);
  const Ints di;
  alignas(64) static constexpr auto kLanes = lanes_after_transposing(hn::MaxLanes(Floats()));
  const I lane_of_pixel = hn::Load(di, kLanes.data());
  RowSums sums;
  const TriangleIndices look_up = indices;
  for (std::uint64_t rest = runs.starts & runs.shown; rest != 0; rest &= rest - 1) {
    const int first = std::countr_zero(rest);
    const std::uint64_t deferred = runs.starts & (~std::uint64_t{1} << first);
    const int last = deferred == 0 ? count : std::countr_zero(deferred);
    sums_of_run(triangles[look_up.of(runs.numbers[first])], static_cast<float>(x + first), row,
                first, last, sums);
  }
  for (int i = 0; i < count; i += lanes) {
    const std::uint32_t shown = static_cast<std::uint32_t>(runs.shown >> i) & all;
    if (shown == 0) {
      std::fill_n(pixels + i, lanes, Colour());
      continue;
    }
    // Within each block of four lanes; what that mixes up is put in order last.
    const float* const from = sums.of[i];
    const FourVectors<F> here =
        transposed_blocks(d, hn::Load(d, from), hn::Load(d, from + lanes),
                          hn::Load(d, from + 2 * lanes), hn::Load(d, from + 3 * lanes));
    store(divided(here), mask_of(shown), pixels + i, [&](auto v) HWY_ATTR {
      return hn::TableLookupLanes(v, hn::IndicesFromVec(hn::DFromV<decltype(v)>(), lane_of_pixel));
    });
  }
}
#endif

// `row` may have more than `count` pixels.
template <class Colour>
HWY_INLINE void shade_pixels(const PixelTriangle* triangles, const TriangleIndices& indices,
                             const RowRuns& row, int x, int y, int count, Colour* pixels) {
  const std::uint64_t here = ~std::uint64_t{0} >> (kTileSize - count);
  const RowRuns runs{row.starts & here, row.shown & here, row.numbers};
#if HWY_TARGET != HWY_SCALAR
  if (std::popcount(runs.starts) >= kManyRuns) {
    shade_short_runs(triangles, indices, runs, x, y, count, pixels);
    return;
  }
#endif
  shade_long_runs(triangles, indices, runs, x, y, count, pixels);
}

void shade_row8(const PixelTriangle* triangles, const TriangleIndices& indices, const RowRuns& row,
                int x, int y, int count, image::Rgba8* pixels) {
  shade_pixels(triangles, indices, row, x, y, count, pixels);
}
void shade_row_float(const PixelTriangle* triangles, const TriangleIndices& indices,
                     const RowRuns& row, int x, int y, int count, image::RgbaF* pixels) {
  shade_pixels(triangles, indices, row, x, y, count, pixels);
}

template <class Colour>
HWY_INLINE void store_block(const shading::Vectors16& colours, std::uint32_t shown,
                            Colour* pixels) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < kBlockSize; i += lanes) {
    store({hn::Load(d, colours.x.lane + i), hn::Load(d, colours.y.lane + i),
           hn::Load(d, colours.z.lane + i)},
          mask_of(shown >> i), pixels + i);
  }
}
void store_colours8(const shading::Vectors16& colours, std::uint32_t shown, image::Rgba8* pixels) {
  store_block(colours, shown, pixels);
}
void store_colours_float(const shading::Vectors16& colours, std::uint32_t shown,
                         image::RgbaF* pixels) {
  store_block(colours, shown, pixels);
}

// The upper halves of a vector's worth of keys.
HWY_INLINE I codes_of(const std::int64_t* keys) {
  const Ints d;
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(d, static_cast<std::int32_t>(*keys >> 32));
#else
  const hn::Repartition<std::int64_t, Ints> d64;
  const auto low = hn::LoadU(d64, keys);
  const auto high = hn::LoadU(d64, keys + hn::Lanes(d64));
  return hn::ConcatOdd(d, hn::BitCast(d, high), hn::BitCast(d, low));
#endif
}

void store_depths(const std::int64_t* keys, int count, const scenes::View* view, float* depths) {
  const Floats d;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  std::int64_t rest[kBlockSize] = {};
  for (int i = 0; i < count; i += lanes) {
    const std::int64_t* here = keys + i;
    if (i + lanes > count) here = std::copy(here, keys + count, rest) - (count - i);
    const I code = codes_of(here);
    const F depth = hn::BitCast(d, hn::Not(code));
    F shown = depth;
    if (view != nullptr && view->orthographic) {
      const F range = hn::Set(d, view->far - view->near);
      shown = hn::Add(hn::Set(d, view->far), hn::Mul(depth, range));
    } else if (view != nullptr) {
      shown = hn::Div(hn::Set(d, -view->near), depth);
    }
    const auto empty = hn::RebindMask(d, hn::Eq(code, hn::Set(di, kEmptyCode)));
    hn::StoreU(hn::IfThenElse(empty, hn::Set(d, image::kEmptyDepth), shown), d, depths + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(shade_row8);
HWY_EXPORT(shade_row_float);
HWY_EXPORT(store_colours8);
HWY_EXPORT(store_colours_float);
HWY_EXPORT(store_depths);

void shade_row(std::span<const PixelTriangle> triangles, const TriangleIndices& indices,
               const RowRuns& row, int x, int y, int count, image::Rgba8* pixels) {
  HWY_DYNAMIC_DISPATCH(shade_row8)
  (triangles.data(), indices, row, x, y, count, pixels);
}
void shade_row(std::span<const PixelTriangle> triangles, const TriangleIndices& indices,
               const RowRuns& row, int x, int y, int count, image::RgbaF* pixels) {
  HWY_DYNAMIC_DISPATCH(shade_row_float)
  (triangles.data(), indices, row, x, y, count, pixels);
}

void store_colours(const shading::Vectors16& colours, shading::LaneMask shown,
                   image::Rgba8* pixels) {
  HWY_DYNAMIC_DISPATCH(store_colours8)(colours, shown, pixels);
}
void store_colours(const shading::Vectors16& colours, shading::LaneMask shown,
                   image::RgbaF* pixels) {
  HWY_DYNAMIC_DISPATCH(store_colours_float)(colours, shown, pixels);
}

void store_depths(const std::int64_t* keys, int count, const scenes::View* view, float* depths) {
  HWY_DYNAMIC_DISPATCH(store_depths)(keys, count, view, depths);
}

}  // namespace delray::raster
#endif
