// Boxes, edge functions and slopes of many triangles at a time: what tile_triangle.h does
// for one.
//
// Compiled once per instruction set, so it has a guard of Highway's kind.
#if defined(DELRAY_RASTER_TRIANGLE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_RASTER_TRIANGLE_LANES
#undef DELRAY_RASTER_TRIANGLE_LANES
#else
#define DELRAY_RASTER_TRIANGLE_LANES
#endif

#include <hwy/highway.h>

#include "raster/pipeline/screen.h"

#ifndef DELRAY_RASTER_MOST_LANES
#define DELRAY_RASTER_MOST_LANES
namespace delray::raster {
// Most vectors have so many lanes at most.
inline constexpr std::size_t kMostLanes = 16;
}  // namespace delray::raster
#endif

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Ints = HWY_CAPPED(std::int32_t, kMostLanes);
using Floats = hn::RebindToFloat<Ints>;
using Bytes = hn::Rebind<std::uint8_t, Ints>;
using Doubles = HWY_CAPPED(double, kMostLanes / 2);
using DoubleInts = hn::Rebind<std::int32_t, Doubles>;
using DoubleFloats = hn::Rebind<float, Doubles>;
using I = hn::Vec<Ints>;
using F = hn::Vec<Floats>;
using Mask = hn::Mask<Ints>;

HWY_INLINE I low_half(I v) { return hn::And(v, hn::Set(Ints(), 0xFFFF)); }
HWY_INLINE I high_half(I v) { return hn::ShiftRight<16>(v); }

template <class V>
HWY_INLINE void append(V v, hn::Mask<hn::DFromV<V>> mask, hn::TFromD<hn::DFromV<V>>* to) {
  // Whole vectors: storing some lanes of a compressed one is slow where it is one instruction.
  hn::StoreU(hn::Compress(v, mask), hn::DFromV<V>(), to);
}

// Where triangles are seen from: a pixel of the frame.
struct Origins {
  I x, y;
};

// The pixels, seen from the origin, whose centres lie in the box of a triangle.
struct Boxes {
  I x0, y0, x1, y1;  // all inclusive
};
HWY_INLINE Boxes boxes_of(const geometry::Rect& clip, const Origins& origin, I ax, I ay, I bx, I by,
                          I cx, I cy) {
  const Ints d;
  const auto first = [&](I a, I b, I c) {
    return hn::ShiftRight<kSubpixelBits>(
        hn::Add(hn::Min(hn::Min(a, b), c), hn::Set(d, kHalfPixel - 1)));
  };
  const auto last = [&](I a, I b, I c) {
    return hn::ShiftRight<kSubpixelBits>(
        hn::Sub(hn::Max(hn::Max(a, b), c), hn::Set(d, kHalfPixel)));
  };
  return {hn::Max(first(ax, bx, cx), hn::Sub(hn::Set(d, clip.x0), origin.x)),
          hn::Max(first(ay, by, cy), hn::Sub(hn::Set(d, clip.y0), origin.y)),
          hn::Min(last(ax, bx, cx), hn::Sub(hn::Set(d, clip.x1 - 1), origin.x)),
          hn::Min(last(ay, by, cy), hn::Sub(hn::Set(d, clip.y1 - 1), origin.y))};
}

// Corners of triangles: their numbers within the cluster.
struct Corners {
  I a, b, c;
};
// The corners at places [place, place + lanes), from arrays of which the next corner's is `stride`
// farther.
HWY_INLINE Corners load_corners(const std::uint8_t* corners, std::size_t stride,
                                std::size_t place) {
  const Ints d;
  const Bytes db;
  return {hn::PromoteTo(d, hn::LoadU(db, corners + place)),
          hn::PromoteTo(d, hn::LoadU(db, corners + stride + place)),
          hn::PromoteTo(d, hn::LoadU(db, corners + 2 * stride + place))};
}

// The triangles that are not culled by their side: see PreparedDraw::hidden_side.
HWY_INLINE Mask shown_of(int hidden_side, Mask clockwise, Mask counter) {
  return hidden_side == 0 ? hn::Or(clockwise, counter) : hidden_side > 0 ? counter : clockwise;
}

// An edge function at the first pixel of each triangle's box, less 1 where the edge is neither top
// nor left, and its steps; see tile_triangle.h.
struct Edges {
  I value, step_x, step_y;
};
HWY_INLINE Edges edges_of(I px, I py, I qx, I qy, I x, I y) {
  const Ints d;
  const I dx = hn::Sub(qx, px), dy = hn::Sub(qy, py);
  const I zero = hn::Zero(d);
  const Mask top_left = hn::Or(hn::Lt(dy, zero), hn::And(hn::Eq(dy, zero), hn::Gt(dx, zero)));
  const I value = hn::Sub(hn::Mul(dx, hn::Sub(y, py)), hn::Mul(dy, hn::Sub(x, px)));
  return {hn::Sub(value, hn::IfThenZeroElse(top_left, hn::Set(d, 1))),
          hn::ShiftLeft<kSubpixelBits>(hn::Neg(dy)), hn::ShiftLeft<kSubpixelBits>(dx)};
}

// Slopes of depth per pixel, by the arithmetic of make_tile_triangle: in double, some lanes at a
// time.
struct Slopes {
  F x, y;
};
HWY_INLINE Slopes slopes_of(I x1_, I y1_, I x2_, I y2_, F d0_, F d1_, F d2_) {
  const Ints d;
  const Floats df;
  const Doubles dd;
  const DoubleInts di2;
  const DoubleFloats df2;
  HWY_ALIGN std::int32_t edges[4][kMostLanes];
  HWY_ALIGN float depths[3][kMostLanes];
  HWY_ALIGN float slopes[2][kMostLanes];
  hn::Store(x1_, d, edges[0]);
  hn::Store(y1_, d, edges[1]);
  hn::Store(x2_, d, edges[2]);
  hn::Store(y2_, d, edges[3]);
  hn::Store(d0_, df, depths[0]);
  hn::Store(d1_, df, depths[1]);
  hn::Store(d2_, df, depths[2]);
  for (std::size_t k = 0; k < hn::Lanes(d); k += hn::Lanes(dd)) {
    const auto x1 = hn::PromoteTo(dd, hn::Load(di2, edges[0] + k));
    const auto y1 = hn::PromoteTo(dd, hn::Load(di2, edges[1] + k));
    const auto x2 = hn::PromoteTo(dd, hn::Load(di2, edges[2] + k));
    const auto y2 = hn::PromoteTo(dd, hn::Load(di2, edges[3] + k));
    const auto d0 = hn::PromoteTo(dd, hn::Load(df2, depths[0] + k));
    const auto d1 = hn::Sub(hn::PromoteTo(dd, hn::Load(df2, depths[1] + k)), d0);
    const auto d2 = hn::Sub(hn::PromoteTo(dd, hn::Load(df2, depths[2] + k)), d0);
    const auto per_pixel = hn::Div(hn::Set(dd, static_cast<double>(kSubpixels)),
                                   hn::Sub(hn::Mul(x1, y2), hn::Mul(x2, y1)));
    const auto slope_x = hn::Mul(hn::Sub(hn::Mul(d1, y2), hn::Mul(d2, y1)), per_pixel);
    const auto slope_y = hn::Mul(hn::Sub(hn::Mul(d2, x1), hn::Mul(d1, x2)), per_pixel);
    hn::Store(hn::DemoteTo(df2, slope_x), df2, slopes[0] + k);
    hn::Store(hn::DemoteTo(df2, slope_y), df2, slopes[1] + k);
  }
  return {hn::Load(df, slopes[0]), hn::Load(df, slopes[1])};
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#endif
