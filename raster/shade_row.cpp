#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "image/srgb.h"
#include "raster/internal/shade_gouraud.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/shade_row.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

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

// A vector with so many changes of triangle at most is shaded run by run.
inline constexpr int kMostChanges = 6;

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

// What pixels look up of their triangles, before anything is divided.
struct Corners {
  F u[3];
  F colour[3][3];  // [corner][channel]
};

// The shares of a triangle's corners at pixels (x, y): the arithmetic of quick_weights_at.
HWY_INLINE void shares(const PixelTriangle& t, F x, float y, F (&u)[3]) {
  const Floats d;
  const F dx = hn::Sub(x, hn::Set(d, t.x));
  const float dy = y - t.y;
  for (int k = 0; k < 3; ++k)
    u[k] = hn::Add(hn::Add(hn::Mul(hn::Set(d, t.a[k]), dx), hn::Set(d, t.b[k] * dy)),
                   hn::Set(d, t.c[k]));
}

HWY_INLINE Corners corners_of(const PixelTriangle& t, F x, float y) {
  const Floats d;
  Corners corners;
  shares(t, x, y, corners.u);
  for (int k = 0; k < 3; ++k)
    for (int channel = 0; channel < 3; ++channel)
      corners.colour[k][channel] = hn::Set(d, t.colour[k][channel]);
  return corners;
}

// The same where `lanes` are set; the other pixels stay as they are.
HWY_INLINE void set_corners(hn::Mask<Floats> lanes, const PixelTriangle& t, F x, float y,
                            Corners& corners) {
  const Floats d;
  F u[3];
  shares(t, x, y, u);
  for (int k = 0; k < 3; ++k) {
    corners.u[k] = hn::IfThenElse(lanes, u[k], corners.u[k]);
    for (int channel = 0; channel < 3; ++channel)
      corners.colour[k][channel] =
          hn::IfThenElse(lanes, hn::Set(d, t.colour[k][channel]), corners.colour[k][channel]);
  }
}

// The arithmetic of quick_weights_at and interpolate.
HWY_INLINE Colours interpolated(const Corners& corners) {
  const Floats d;
  const F zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  F u[3];
  for (int k = 0; k < 3; ++k) u[k] = hn::IfThenElseZero(hn::Gt(corners.u[k], zero), corners.u[k]);
  const F sum = hn::Add(hn::Add(u[0], u[1]), u[2]);
  const auto some = hn::Ge(sum, hn::Set(d, kLeastSum));
  const F share = hn::Div(one, sum);
  const F w0 = hn::IfThenElse(some, hn::Mul(u[0], share), one);
  const F w1 = hn::IfThenElseZero(some, hn::Mul(u[1], share));
  const F w2 = hn::IfThenElseZero(some, hn::Mul(u[2], share));
  const auto channel = [&](int k) {
    return hn::Add(hn::Add(hn::Mul(corners.colour[0][k], w0), hn::Mul(corners.colour[1][k], w1)),
                   hn::Mul(corners.colour[2][k], w2));
  };
  return {channel(0), channel(1), channel(2)};
}

// The same of one pixel, to colour[0 .. 3]: quicker than to gather from sixteen triangles.
HWY_INLINE void interpolate_one(const PixelTriangle& t, float x, float y, float* colour) {
#if HWY_TARGET == HWY_SCALAR
  const Colours colours = interpolated(corners_of(t, hn::Set(Floats(), x), y));
  colour[0] = hn::GetLane(colours.red);
  colour[1] = hn::GetLane(colours.green);
  colour[2] = hn::GetLane(colours.blue);
#else
  const HWY_CAPPED(float, 4) d;
  const auto zero = hn::Zero(d);
  const auto plane = hn::Add(hn::Add(hn::Mul(hn::LoadU(d, t.a), hn::Set(d, x - t.x)),
                                     hn::Mul(hn::LoadU(d, t.b), hn::Set(d, y - t.y))),
                             hn::LoadU(d, t.c));
  const auto u = hn::IfThenElseZero(hn::Gt(plane, zero), plane);
  const auto sum = hn::Add(hn::Add(hn::Broadcast<0>(u), hn::Broadcast<1>(u)), hn::Broadcast<2>(u));
  const auto one = hn::Set(d, 1.0F);
  const auto w = hn::IfThenElse(hn::Ge(sum, hn::Set(d, kLeastSum)), hn::Mul(u, hn::Div(one, sum)),
                                hn::IfThenElseZero(hn::FirstN(d, 1), one));
  hn::Store(hn::Add(hn::Add(hn::Mul(hn::LoadU(d, t.colour[0]), hn::Broadcast<0>(w)),
                            hn::Mul(hn::LoadU(d, t.colour[1]), hn::Broadcast<1>(w))),
                    hn::Mul(hn::LoadU(d, t.colour[2]), hn::Broadcast<2>(w))),
            d, colour);
#endif
}

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

// A code before it is rounded, within kCodeError. Whatever is not above 0 counts as 0, what is
// above 1 as 1.
HWY_INLINE F estimated_code(F linear) {
  const Floats d;
  const Ints di;
  const F positive = hn::IfThenElseZero(hn::Gt(linear, hn::Zero(d)), linear);
  const F x = hn::Min(positive, hn::Set(d, 1.0F));
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
    if (HWY_LIKELY(hn::AllTrue(d, hn::Lt(farthest, hn::Set(d, 0.5F - kCodeError)))))
      return {hn::BitCast(di, rounded[0]), hn::BitCast(di, rounded[1]),
              hn::BitCast(di, rounded[2])};
  }
  return {looked_up_code(colours.red), looked_up_code(colours.green), looked_up_code(colours.blue)};
}

HWY_INLINE void store(const Colours& colours, hn::Mask<Ints> shown, image::Rgba8* pixels) {
  const Ints d;
  const Codes codes = encoded(colours);
  const I code = hn::Or(
      hn::Or(codes.red, hn::ShiftLeft<8>(codes.green)),
      hn::Or(hn::ShiftLeft<16>(codes.blue), hn::Set(d, static_cast<std::int32_t>(0xFF000000U))));
  hn::StoreU(hn::IfThenElseZero(shown, code), d, reinterpret_cast<std::int32_t*>(pixels));
}
HWY_INLINE void store(const Colours& colours, hn::Mask<Ints> shown, image::RgbaF* pixels) {
  const Floats d;
  const auto mask = hn::RebindMask(d, shown);
  hn::StoreInterleaved4(
      hn::IfThenElseZero(mask, colours.red), hn::IfThenElseZero(mask, colours.green),
      hn::IfThenElseZero(mask, colours.blue), hn::IfThenElseZero(mask, hn::Set(d, 1.0F)), d,
      reinterpret_cast<float*>(pixels));
}

// Bit k: lane k + 1 has another triangle than lane k; whatever the last lane has.
HWY_INLINE std::uint32_t changes_of(hn::Mask<Ints> changes) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Ints(), changes, bytes);
  const std::uint32_t bits = bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8;
  return bits & ((1U << (hn::Lanes(Ints()) - 1)) - 1);
}

template <class Colour>
HWY_INLINE void shade_pixels(const PixelTriangle* triangles, const std::uint16_t* index, int x,
                             int y, int count, Colour* pixels) {
  const Floats d;
  const Ints di;
  const hn::Rebind<std::uint16_t, Ints> d16;
  const int lanes = static_cast<int>(hn::Lanes(d));
  // A constant; counted from a variable, lanes are filled one by one.
  const I lane_numbers = hn::Iota(di, 0);
  const auto row = static_cast<float>(y);
  // No triangle is any triangle whose colour is not shown: without a branch, which would often be
  // guessed wrong.
  const auto triangle_at = [&](int i) -> const PixelTriangle& {
    return triangles[index[i] == kNoTriangle ? std::uint16_t{0} : index[i]];
  };
  for (int i = 0; i < count; i += lanes) {
    const I triangle = hn::PromoteTo(di, hn::LoadU(d16, index + i));
    const I columns = hn::Add(hn::Set(di, x + i), lane_numbers);
    const F column = hn::ConvertTo(d, columns);
    if (hn::AllTrue(di, hn::Eq(triangle, hn::Set(di, index[i])))) {
      if (index[i] == kNoTriangle)
        std::fill_n(pixels + i, lanes, Colour());
      else
        store(interpolated(corners_of(triangles[index[i]], column, row)),
              hn::Eq(triangle, triangle), pixels + i);
      continue;
    }
    const auto shown = hn::Ne(triangle, hn::Set(di, kNoTriangle));
    const I next = hn::PromoteTo(di, hn::LoadU(d16, index + i + 1));
    std::uint32_t changes = changes_of(hn::Ne(triangle, next));
    if (std::popcount(changes) <= kMostChanges) {
      Corners corners = corners_of(triangle_at(i), column, row);
      for (; changes != 0; changes &= changes - 1) {
        const int k = std::countr_zero(changes) + 1;
        const auto rest = hn::Gt(columns, hn::Set(di, x + i + k - 1));
        set_corners(hn::RebindMask(d, rest), triangle_at(i + k), column, row, corners);
      }
      store(interpolated(corners), shown, pixels + i);
      continue;
    }
    HWY_ALIGN float colours[4 * kBlockSize];
    for (int k = 0; k < lanes; ++k)
      interpolate_one(triangle_at(i + k), static_cast<float>(x + i + k), row, colours + 4 * k);
    F red, green, blue, unused;
    hn::LoadInterleaved4(d, colours, red, green, blue, unused);
    store({red, green, blue}, shown, pixels + i);
  }
}

void shade_row8(const PixelTriangle* triangles, const std::uint16_t* index, int x, int y, int count,
                image::Rgba8* pixels) {
  shade_pixels(triangles, index, x, y, count, pixels);
}
void shade_row_float(const PixelTriangle* triangles, const std::uint16_t* index, int x, int y,
                     int count, image::RgbaF* pixels) {
  shade_pixels(triangles, index, x, y, count, pixels);
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

void store_depths(const std::int64_t* keys, int count, float near, float* depths) {
  const Floats d;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  std::int64_t rest[kBlockSize] = {};
  for (int i = 0; i < count; i += lanes) {
    const std::int64_t* here = keys + i;
    if (i + lanes > count) here = std::copy(here, keys + count, rest) - (count - i);
    const I code = codes_of(here);
    const F depth = hn::BitCast(d, hn::Not(code));
    const F shown = near > 0 ? hn::Div(hn::Set(d, -near), depth) : depth;
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
HWY_EXPORT(store_depths);

void shade_row(std::span<const PixelTriangle> triangles, const std::uint16_t* index, int x, int y,
               int count, image::Rgba8* pixels) {
  HWY_DYNAMIC_DISPATCH(shade_row8)(triangles.data(), index, x, y, count, pixels);
}
void shade_row(std::span<const PixelTriangle> triangles, const std::uint16_t* index, int x, int y,
               int count, image::RgbaF* pixels) {
  HWY_DYNAMIC_DISPATCH(shade_row_float)(triangles.data(), index, x, y, count, pixels);
}

void store_depths(const std::int64_t* keys, int count, float near, float* depths) {
  HWY_DYNAMIC_DISPATCH(store_depths)(keys, count, near, depths);
}

}  // namespace delray::raster
#endif
