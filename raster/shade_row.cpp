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

// Of pixels (x, y) that show the same triangle: the arithmetic of weights_at and interpolate.
HWY_INLINE Colours interpolated(const PixelTriangle& t, F x, F y) {
  const Floats d;
  const auto set = [&](float value) { return hn::Set(d, value); };
  const F zero = hn::Zero(d), one = set(1.0F);
  const F dx = hn::Sub(x, set(t.x)), dy = hn::Sub(y, set(t.y));
  F u[3];
  for (int k = 0; k < 3; ++k) {
    const F plane =
        hn::Add(hn::Add(hn::Mul(set(t.a[k]), dx), hn::Mul(set(t.b[k]), dy)), set(t.c[k]));
    u[k] = hn::IfThenElseZero(hn::Gt(plane, zero), plane);
  }
  const F sum = hn::Add(hn::Add(u[0], u[1]), u[2]);
  const auto some = hn::Gt(sum, zero);
  const F w0 = hn::IfThenElse(some, hn::Div(u[0], sum), one);
  const F w1 = hn::IfThenElseZero(some, hn::Div(u[1], sum));
  const F w2 = hn::IfThenElseZero(some, hn::Div(u[2], sum));
  const auto channel = [&](int k) {
    return hn::Add(hn::Add(hn::Mul(set(t.colour[0][k]), w0), hn::Mul(set(t.colour[1][k]), w1)),
                   hn::Mul(set(t.colour[2][k]), w2));
  };
  return {channel(0), channel(1), channel(2)};
}

// The same of one pixel, to colour[0 .. 3]: quicker than to gather from sixteen triangles.
HWY_INLINE void interpolate_one(const PixelTriangle& t, float x, float y, float* colour) {
#if HWY_TARGET == HWY_SCALAR
  const hn::Vec<Floats> columns = hn::Set(Floats(), x), rows = hn::Set(Floats(), y);
  const Colours colours = interpolated(t, columns, rows);
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
  const auto w = hn::IfThenElse(hn::Gt(sum, zero), hn::Div(u, sum),
                                hn::IfThenElseZero(hn::FirstN(d, 1), hn::Set(d, 1.0F)));
  hn::Store(hn::Add(hn::Add(hn::Mul(hn::LoadU(d, t.colour[0]), hn::Broadcast<0>(w)),
                            hn::Mul(hn::LoadU(d, t.colour[1]), hn::Broadcast<1>(w))),
                    hn::Mul(hn::LoadU(d, t.colour[2]), hn::Broadcast<2>(w))),
            d, colour);
#endif
}

// image::encode_srgb.
HWY_INLINE I encoded(F linear) {
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

HWY_INLINE void store(const Colours& colours, hn::Mask<Ints> shown, image::Rgba8* pixels) {
  const Ints d;
  const I code = hn::Or(hn::Or(encoded(colours.red), hn::ShiftLeft<8>(encoded(colours.green))),
                        hn::Or(hn::ShiftLeft<16>(encoded(colours.blue)),
                               hn::Set(d, static_cast<std::int32_t>(0xFF000000U))));
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

template <class Colour>
HWY_INLINE void shade_pixels(const PixelTriangle* triangles, const std::uint16_t* index, int x,
                             int y, int count, Colour* pixels) {
  const Floats d;
  const Ints di;
  const hn::Rebind<std::uint16_t, Ints> d16;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const F row = hn::Set(d, static_cast<float>(y));
  for (int i = 0; i < count; i += lanes) {
    const F column = hn::ConvertTo(d, hn::Iota(di, x + i));
    const I triangle = hn::PromoteTo(di, hn::LoadU(d16, index + i));
    const I first = hn::Set(di, index[i]);
    if (hn::AllTrue(di, hn::Eq(triangle, first))) {
      if (index[i] == kNoTriangle) {
        std::fill_n(pixels + i, lanes, Colour());
        continue;
      }
      store(interpolated(triangles[index[i]], column, row), hn::Eq(triangle, triangle), pixels + i);
      continue;
    }
    HWY_ALIGN float colours[4 * kBlockSize];
    for (int k = 0; k < lanes; ++k) {
      // There is a triangle, or all would be equal; without a branch, which would often be guessed
      // wrong.
      const std::uint16_t t = index[i + k] == kNoTriangle ? std::uint16_t{0} : index[i + k];
      interpolate_one(triangles[t], static_cast<float>(x + i + k), static_cast<float>(y),
                      colours + 4 * k);
    }
    F red, green, blue, unused;
    hn::LoadInterleaved4(d, colours, red, green, blue, unused);
    store({red, green, blue}, hn::Not(hn::Eq(triangle, hn::Set(di, kNoTriangle))), pixels + i);
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

void store_depths(const std::int64_t* keys, int count, float near, float* depths) {
  const Floats d;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  HWY_ALIGN std::int32_t halves[2 * kBlockSize] = {};
  for (int i = 0; i < count; i += lanes) {
    const int here = std::min(lanes, count - i);
    if (here == lanes)  // a size that the compiler knows
      std::memcpy(halves, keys + i, sizeof(std::int64_t) * hn::Lanes(d));
    else
      std::memcpy(halves, keys + i, sizeof(std::int64_t) * static_cast<std::size_t>(here));
    I number, code;
    hn::LoadInterleaved2(di, halves, number, code);
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
