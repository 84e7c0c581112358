// Small triangles of a cluster, a vector of them at a time: as windows of tiles, or as fragments,
// pixel by pixel of their boxes.
//
// Compiled once per instruction set, so it has a guard of Highway's kind.
#if defined(DELRAY_RASTER_SMALL_TRIANGLES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_RASTER_SMALL_TRIANGLES
#undef DELRAY_RASTER_SMALL_TRIANGLES
#else
#define DELRAY_RASTER_SMALL_TRIANGLES
#endif

#include <hwy/highway.h>

#include "raster/pipeline/cluster_set_up.h"
#include "raster/pipeline/triangle_lanes.h"
#include "raster/pipeline/visibility.h"

#ifndef DELRAY_RASTER_SMALL_TRIANGLES_HELD
#define DELRAY_RASTER_SMALL_TRIANGLES_HELD
namespace delray::raster {

// Values that a cluster's triangles have in common. Each is set up as seen from an origin of its
// own, a pixel's corner in the frame; that of a compact cluster's triangles is one and the same.
struct ClusterInSetUp {
  explicit ClusterInSetUp(const ClusterToSetUp& cluster)
      : wanted(cluster),
        vertices(cluster.on_screen.vertices),
        clip(cluster.clip),
        centre_x(cluster.on_screen.screen.centre_x),
        centre_y(cluster.on_screen.screen.centre_y),
        tiles_x(cluster.on_screen.screen.tiles_x),
        first_number(cluster.first_number) {}

  const ClusterToSetUp& wanted;
  const ScreenVertices& vertices;
  std::int32_t position[kClusterVertices + ScreenVertices::kPadding];  // if compact: x | y << 16
  int origin_x = 0, origin_y = 0;                                      // if compact
  geometry::Rect clip;                                                 // pixels of the frame
  DepthsAround around;                                                 // in them
  int centre_x, centre_y, tiles_x;                                     // the screen's
  std::uint32_t first_number;                                          // at place 0
};

// Small triangles: positions x | y << 16 of the corners seen from the origin, and their numbers a |
// b << 8 | c << 16 | place << 24. Corners run clockwise on the screen.
struct SmallTriangles {
  static constexpr std::size_t kSize = kClusterTriangles + kMostLanes;
  std::int32_t a[kSize], b[kSize], c[kSize], corners[kSize], origin_x[kSize], origin_y[kSize];
  std::size_t size = 0;
};

}  // namespace delray::raster
#endif

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A vector of small triangles, set up; lanes without a triangle have no rows.
struct SmallSetUp {
  Origins origin;
  Boxes box;
  I columns, rows;  // less 1
  Edges e0, e1, e2;
  Slopes slope;
  F depth, nearest, farthest;
  F from_x, from_y;  // of the box's first pixel centre from the first vertex, in pixels
  hn::VFromD<hn::RebindToUnsigned<Ints>> number;
};

HWY_INLINE SmallSetUp set_up_small(const ClusterInSetUp& cluster, const SmallTriangles& triangles,
                                   std::size_t first, std::size_t count) {
  const Ints d;
  const Floats df;
  const hn::RebindToUnsigned<Ints> du;
  const I a = hn::LoadU(d, triangles.a + first);
  const I b = hn::LoadU(d, triangles.b + first);
  const I c = hn::LoadU(d, triangles.c + first);
  const I corners = hn::LoadU(d, triangles.corners + first);
  const I ax = low_half(a), ay = high_half(a);
  const I bx = low_half(b), by = high_half(b);
  const I cx = low_half(c), cy = high_half(c);
  SmallSetUp s;
  s.origin = {hn::LoadU(d, triangles.origin_x + first), hn::LoadU(d, triangles.origin_y + first)};
  s.box = boxes_of(cluster.clip, s.origin, ax, ay, bx, by, cx, cy);
  const Mask used = hn::FirstN(d, count);
  const I none = hn::Set(d, -1);
  s.columns = hn::IfThenElse(used, hn::Sub(s.box.x1, s.box.x0), none);
  s.rows = hn::IfThenElse(used, hn::Sub(s.box.y1, s.box.y0), none);

  const I half = hn::Set(d, kHalfPixel);
  const I x = hn::Add(hn::ShiftLeft<kSubpixelBits>(s.box.x0), half);
  const I y = hn::Add(hn::ShiftLeft<kSubpixelBits>(s.box.y0), half);
  s.e0 = edges_of(ax, ay, bx, by, x, y);
  s.e1 = edges_of(bx, by, cx, cy, x, y);
  s.e2 = edges_of(cx, cy, ax, ay, x, y);

  const I byte = hn::Set(d, 0xFF);
  const float* depths = cluster.vertices.depth;
  const F depth0 = hn::GatherIndex(df, depths, hn::And(corners, byte));
  const F depth1 = hn::GatherIndex(df, depths, hn::And(hn::ShiftRight<8>(corners), byte));
  const F depth2 = hn::GatherIndex(df, depths, hn::And(hn::ShiftRight<16>(corners), byte));
  s.slope = slopes_of(hn::Sub(bx, ax), hn::Sub(by, ay), hn::Sub(cx, ax), hn::Sub(cy, ay), depth0,
                      depth1, depth2);
  s.depth = depth0;
  s.nearest = hn::Min(hn::Min(depth0, depth1), depth2);
  s.farthest = hn::Max(hn::Max(depth0, depth1), depth2);
  // Whole numbers of subpixels below 2^24: exact.
  const F per_subpixel = hn::Set(df, 1.0F / kSubpixels);
  s.from_x = hn::Mul(hn::ConvertTo(df, hn::Sub(x, ax)), per_subpixel);
  s.from_y = hn::Mul(hn::ConvertTo(df, hn::Sub(y, ay)), per_subpixel);
  s.number =
      hn::Add(hn::Set(du, cluster.first_number), hn::ShiftRight<24>(hn::BitCast(du, corners)));
  return s;
}

// Four vectors, lane after lane; elements past the last lane may be overwritten.
template <class V>
HWY_INLINE void store4(V a, V b, V c, V d, void* to) {
  hn::StoreInterleaved4(a, b, c, d, hn::DFromV<V>(), static_cast<hn::TFromV<V>*>(to));
}

// One vector of triangles from `first` on, at most `count` of them, as windows.
inline void set_up_windows(const ClusterInSetUp& cluster, const SmallTriangles& triangles,
                           std::size_t first, std::size_t count, WindowTriangles& windows) {
  const Ints d;
  const Floats df;
  const SmallSetUp s = set_up_small(cluster, triangles, first, count);
  // Windows start at multiples of their width: what one triangle has stored is soon loaded again
  // for the next, which is slow unless both are the same vectors.
  static_assert(WindowTriangles::kWindowWidth == 8);
  const I pixel_x = hn::Add(s.box.x0, s.origin.x), pixel_y = hn::Add(s.box.y0, s.origin.y);
  const I in_tile = hn::Set(d, kTileSize - 1);
  const I x = hn::And(pixel_x, in_tile), y = hn::And(pixel_y, in_tile);
  const I before = hn::And(x, hn::Set(d, 7));
  const I start = hn::Sub(x, before);
  const I parts = hn::Add(hn::ShiftRight<3>(hn::Add(before, s.columns)), hn::Set(d, 1));
  static_assert(WindowTriangles::kRowsAtOnce == 4);
  const I groups = hn::Add(hn::ShiftRight<2>(s.rows), hn::Set(d, 1));
  const I rows = hn::ShiftLeft<2>(groups);
  const I above = hn::Max(hn::Sub(hn::Add(y, rows), hn::Set(d, kTileSize)), hn::Zero(d));
  const I below = hn::Sub(hn::Sub(rows, hn::Add(s.rows, hn::Set(d, 1))), above);
  const auto at_start = [&](const Edges& e) {
    return hn::Sub(e.value, hn::Add(hn::Mul(e.step_x, before), hn::Mul(e.step_y, above)));
  };
  const F from_x = hn::Sub(s.from_x, hn::ConvertTo(df, before));
  const F from_y = hn::Sub(s.from_y, hn::ConvertTo(df, above));
  const I window = hn::Or(hn::Or(hn::Or(start, hn::ShiftLeft<6>(hn::Sub(y, above))),
                                 hn::Or(hn::ShiftLeft<12>(above), hn::ShiftLeft<14>(below))),
                          hn::Or(hn::ShiftLeft<16>(groups), hn::ShiftLeft<20>(parts)));
  const std::size_t n = windows.size;
  const I zero = hn::Zero(d);
  store4(at_start(s.e0), at_start(s.e1), at_start(s.e2), window, windows.edges.data() + n);
  store4(s.e0.step_x, s.e1.step_x, s.e2.step_x, hn::BitCast(d, s.number),
         windows.columns.data() + n);
  store4(s.e0.step_y, s.e1.step_y, s.e2.step_y, zero, windows.rows.data() + n);
  store4(s.slope.x, s.slope.y, from_x, from_y, windows.planes.data() + n);
  store4(s.depth, s.nearest, s.farthest, hn::Zero(df), windows.depths.data() + n);
  const I tile = hn::Add(hn::Mul(hn::ShiftRight<6>(pixel_y), hn::Set(d, cluster.tiles_x)),
                         hn::ShiftRight<6>(pixel_x));
  hn::StoreU(tile, d, reinterpret_cast<std::int32_t*>(windows.tile.data() + n));
  windows.size += count;
}

// One vector of small triangles from `first` on, at most `count` of them, pixel by pixel.
inline void draw_small(const ClusterInSetUp& cluster, const SmallTriangles& triangles,
                       std::size_t first, std::size_t count, SetUpResult& result) {
  const Ints d;
  const Floats df;
  const hn::RebindToUnsigned<Ints> du;
  const SmallSetUp s = set_up_small(cluster, triangles, first, count);
  const auto& [origin, box, columns, rows, e0, e1, e2, slope, depth0, nearest, farthest, from_x,
               from_y, number] = s;
  const I none = hn::Set(d, -1);
  const int most_columns = hn::GetLane(hn::MaxOfLanes(d, columns));
  const int most_rows = hn::GetLane(hn::MaxOfLanes(d, rows));
  const I pixel_x = hn::Add(box.x0, origin.x), pixel_y = hn::Add(box.y0, origin.y);

  I row0 = e0.value, row1 = e1.value, row2 = e2.value;
  for (int j = 0; j <= most_rows; ++j) {
    const F plane_y = hn::Mul(slope.y, hn::Add(from_y, hn::Set(df, static_cast<float>(j))));
    const I in_rows = hn::Sub(rows, hn::Set(d, j));
    const I at_y = hn::Add(pixel_y, hn::Set(d, j));
    const I tile_row = hn::Mul(hn::ShiftRight<6>(at_y), hn::Set(d, cluster.tiles_x));
    const I row_address = hn::ShiftLeft<6>(hn::And(at_y, hn::Set(d, kTileSize - 1)));
    I value0 = row0, value1 = row1, value2 = row2;
    for (int i = 0; i <= most_columns; ++i) {
      const I in_box = hn::Or(in_rows, hn::Sub(columns, hn::Set(d, i)));
      const I sign = hn::Or(hn::Or(value0, value1), hn::Or(value2, in_box));
      const Mask covered = hn::Gt(sign, none);
      value0 = hn::Add(value0, e0.step_x);
      value1 = hn::Add(value1, e1.step_x);
      value2 = hn::Add(value2, e2.step_x);
      if (hn::AllFalse(d, covered)) continue;
      const F plane_x = hn::Mul(slope.x, hn::Add(from_x, hn::Set(df, static_cast<float>(i))));
      const F plane = hn::Add(hn::Add(plane_x, plane_y), depth0);
      const F z = hn::Min(hn::Max(plane, nearest), farthest);
      const I at_x = hn::Add(pixel_x, hn::Set(d, i));
      const I tile = hn::Add(tile_row, hn::ShiftRight<6>(at_x));
      const I address = hn::Or(hn::ShiftLeft<12>(tile),
                               hn::Or(row_address, hn::And(at_x, hn::Set(d, kTileSize - 1))));
      const auto mask = hn::RebindMask(du, covered);
      append(hn::BitCast(du, address), mask, result.address.data() + result.fragments);
      append(hn::Not(hn::BitCast(du, z)), mask, result.code.data() + result.fragments);
      append(number, mask, result.number.data() + result.fragments);
      result.fragments += hn::CountTrue(d, covered);
    }
    row0 = hn::Add(row0, e0.step_y);
    row1 = hn::Add(row1, e1.step_y);
    row2 = hn::Add(row2, e2.step_y);
  }
}
static_assert(kTileSize == 1 << 6 && kTilePixels == 1 << 12);

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#endif
