#include "raster/internal/cluster_set_up.h"

#include <algorithm>

#include "raster/internal/visibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/cluster_set_up.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

#ifndef DELRAY_RASTER_CLUSTER_SET_UP
#define DELRAY_RASTER_CLUSTER_SET_UP
namespace delray::raster {

// Most vectors have so many lanes at most.
inline constexpr std::size_t kMostLanes = 16;
// Triangles of which at most so many columns and rows of pixel centres lie in the box are drawn
// pixel by pixel, many triangles at a time.
inline constexpr int kSmallSide = 8;
// A cluster is compact if its coordinates, seen from its corner, are below this: products of
// differences then fit 32 bits, and a position fits one word.
inline constexpr int kCompact = 1 << 15;

// Everything that a compact cluster's triangles have in common. Positions are seen from the pixel
// corner (origin_x, origin_y) of the frame.
struct CompactCluster {
  explicit CompactCluster(const ScreenVertices& all) : vertices(all) {}

  const ScreenVertices& vertices;
  std::int32_t position[kClusterVertices + ScreenVertices::kPadding];  // x | y << 16
  int origin_x, origin_y;
  geometry::Rect clip;  // pixels that are wanted
  int tiles_x;
};

// Triangles drawn pixel by pixel: positions of the corners, and their numbers a | b << 8 | c << 16
// | place << 24. Corners run clockwise on the screen.
struct SmallTriangles {
  std::int32_t a[kClusterTriangles + kMostLanes], b[kClusterTriangles + kMostLanes],
      c[kClusterTriangles + kMostLanes], corners[kClusterTriangles + kMostLanes];
  std::size_t size = 0;
};

inline void append_triangle(const Screen& screen, const geometry::Rect& wanted,
                            const ScreenTriangle& triangle, const geometry::Rect& box, bool masked,
                            SetUpResult& result) {
  const geometry::Rect pixels = geometry::intersection(box, wanted);
  if (pixels.empty()) return;
  const int x0 = pixels.x0 / kTileSize, x1 = (pixels.x1 - 1) / kTileSize;
  const int y0 = pixels.y0 / kTileSize, y1 = (pixels.y1 - 1) / kTileSize;
  const bool large = (x1 - x0 + 1) * (y1 - y0 + 1) > kFewTiles;
  auto& triangles = large ? result.large_triangles : result.triangles;
  auto& entries = large ? result.large_entries : result.entries;
  const auto entry = static_cast<std::uint32_t>(triangles.size()) | (masked ? kMasked : 0);
  triangles.push_back(triangle);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x)
      entries.push_back({static_cast<std::uint32_t>(y * screen.tiles_x + x), entry});
}

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

// The pixels, seen from the cluster's origin, whose centres lie in the box of a triangle.
struct Boxes {
  I x0, y0, x1, y1;  // all inclusive
};
HWY_INLINE Boxes boxes_of(const CompactCluster& cluster, I ax, I ay, I bx, I by, I cx, I cy) {
  const Ints d;
  const auto first = [&](I a, I b, I c) {
    return hn::ShiftRight<kSubpixelBits>(
        hn::Add(hn::Min(hn::Min(a, b), c), hn::Set(d, kHalfPixel - 1)));
  };
  const auto last = [&](I a, I b, I c) {
    return hn::ShiftRight<kSubpixelBits>(
        hn::Sub(hn::Max(hn::Max(a, b), c), hn::Set(d, kHalfPixel)));
  };
  return {hn::Max(first(ax, bx, cx), hn::Set(d, cluster.clip.x0)),
          hn::Max(first(ay, by, cy), hn::Set(d, cluster.clip.y0)),
          hn::Min(last(ax, bx, cx), hn::Set(d, cluster.clip.x1 - 1)),
          hn::Min(last(ay, by, cy), hn::Set(d, cluster.clip.y1 - 1))};
}

// An edge function at the first pixel of each triangle's box, less 1 where the edge is neither top
// nor left, and its steps; see internal/tile_triangle.h.
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

// One vector of small triangles from `first` on, at most `count` of them, pixel by pixel.
void draw_small(const CompactCluster& cluster, const SmallTriangles& triangles, std::size_t first,
                std::size_t count, std::uint32_t first_number, SetUpResult& result) {
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
  const Boxes box = boxes_of(cluster, ax, ay, bx, by, cx, cy);
  // Columns and rows less 1; lanes without a triangle have none.
  const Mask used = hn::FirstN(d, count);
  const I none = hn::Set(d, -1);
  const I columns = hn::IfThenElse(used, hn::Sub(box.x1, box.x0), none);
  const I rows = hn::IfThenElse(used, hn::Sub(box.y1, box.y0), none);
  const int most_columns = hn::GetLane(hn::MaxOfLanes(d, columns));
  const int most_rows = hn::GetLane(hn::MaxOfLanes(d, rows));

  const I half = hn::Set(d, kHalfPixel);
  const I x = hn::Add(hn::ShiftLeft<kSubpixelBits>(box.x0), half);
  const I y = hn::Add(hn::ShiftLeft<kSubpixelBits>(box.y0), half);
  const Edges e0 = edges_of(ax, ay, bx, by, x, y);
  const Edges e1 = edges_of(bx, by, cx, cy, x, y);
  const Edges e2 = edges_of(cx, cy, ax, ay, x, y);

  const I byte = hn::Set(d, 0xFF);
  const float* depths = cluster.vertices.depth;
  const F depth0 = hn::GatherIndex(df, depths, hn::And(corners, byte));
  const F depth1 = hn::GatherIndex(df, depths, hn::And(hn::ShiftRight<8>(corners), byte));
  const F depth2 = hn::GatherIndex(df, depths, hn::And(hn::ShiftRight<16>(corners), byte));
  const Slopes slope = slopes_of(hn::Sub(bx, ax), hn::Sub(by, ay), hn::Sub(cx, ax), hn::Sub(cy, ay),
                                 depth0, depth1, depth2);
  const F nearest = hn::Min(hn::Min(depth0, depth1), depth2);
  const F farthest = hn::Max(hn::Max(depth0, depth1), depth2);
  // Whole numbers of subpixels below 2^24: exact.
  const F per_subpixel = hn::Set(df, 1.0F / kSubpixels);
  const F from_x = hn::Mul(hn::ConvertTo(df, hn::Sub(x, ax)), per_subpixel);
  const F from_y = hn::Mul(hn::ConvertTo(df, hn::Sub(y, ay)), per_subpixel);
  const auto number =
      hn::Add(hn::Set(du, first_number), hn::ShiftRight<24>(hn::BitCast(du, corners)));
  const I pixel_x = hn::Add(box.x0, hn::Set(d, cluster.origin_x));
  const I pixel_y = hn::Add(box.y0, hn::Set(d, cluster.origin_y));

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

void set_up_compact(const Screen& screen, const PreparedDraw& draw, const ClusterBlock& block,
                    const MeshCluster& mesh_cluster, const Cluster& places,
                    const CompactCluster& cluster, std::uint32_t first_number,
                    const geometry::Rect& wanted, SetUpResult& result) {
  const Ints d;
  const Bytes db;
  const std::size_t lanes = hn::Lanes(d);
  const std::uint8_t* corners = block.corners.data() + mesh_cluster.first_corner;
  const std::size_t stride = mesh_cluster.corner_stride();
  SmallTriangles small;
  const I zero = hn::Zero(d);
  const I small_side = hn::Set(d, kSmallSide);
  std::size_t kept = 0;
  for (std::size_t place = places.begin / lanes * lanes; place < places.end; place += lanes) {
    // Of a constant; counted from a variable, lanes are filled one by one.
    const I places_here = hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<std::int32_t>(place)));
    const I a = hn::PromoteTo(d, hn::LoadU(db, corners + place));
    const I b = hn::PromoteTo(d, hn::LoadU(db, corners + stride + place));
    const I c = hn::PromoteTo(d, hn::LoadU(db, corners + 2 * stride + place));
    const I pa = hn::GatherIndex(d, cluster.position, a);
    const I pb = hn::GatherIndex(d, cluster.position, b);
    const I pc = hn::GatherIndex(d, cluster.position, c);
    const I ax = low_half(pa), ay = high_half(pa);
    const I bx = low_half(pb), by = high_half(pb);
    const I cx = low_half(pc), cy = high_half(pc);
    const Boxes box = boxes_of(cluster, ax, ay, bx, by, cx, cy);
    const I columns = hn::Sub(box.x1, box.x0), rows = hn::Sub(box.y1, box.y0);
    const I area = hn::Sub(hn::Mul(hn::Sub(bx, ax), hn::Sub(cy, ay)),
                           hn::Mul(hn::Sub(cx, ax), hn::Sub(by, ay)));
    const Mask clockwise = hn::Gt(area, zero), counter = hn::Lt(area, zero);
    const Mask shown = draw.hidden_side == 0  ? hn::Or(clockwise, counter)
                       : draw.hidden_side > 0 ? counter
                                              : clockwise;
    const Mask in_range = hn::And(hn::Gt(places_here, hn::Set(d, places.begin - 1)),
                                  hn::Lt(places_here, hn::Set(d, places.end)));
    const Mask keep =
        hn::And(hn::And(hn::Gt(hn::Or(columns, rows), hn::Set(d, -1)), shown), in_range);
    if (hn::AllFalse(d, keep)) continue;
    kept += hn::CountTrue(d, keep);
    const Mask is_small =
        hn::And(keep, hn::And(hn::Lt(columns, small_side), hn::Lt(rows, small_side)));
    const I turned_b = hn::IfThenElse(counter, c, b), turned_c = hn::IfThenElse(counter, b, c);
    const I names = hn::Or(hn::Or(a, hn::ShiftLeft<8>(turned_b)),
                           hn::Or(hn::ShiftLeft<16>(turned_c), hn::ShiftLeft<24>(places_here)));
    append(pa, is_small, small.a + small.size);
    append(hn::IfThenElse(counter, pc, pb), is_small, small.b + small.size);
    append(hn::IfThenElse(counter, pb, pc), is_small, small.c + small.size);
    append(names, is_small, small.corners + small.size);
    small.size += hn::CountTrue(d, is_small);

    const Mask is_other = hn::AndNot(is_small, keep);
    if (hn::AllFalse(d, is_other)) continue;
    HWY_ALIGN std::int32_t others[kMostLanes];
    append(names, is_other, others);
    const std::size_t count = hn::CountTrue(d, is_other);
    for (std::size_t k = 0; k < count; ++k) {
      const auto name = static_cast<std::uint32_t>(others[k]);
      const ScreenVertex v[3] = {cluster.vertices[name & 0xFF], cluster.vertices[name >> 8 & 0xFF],
                                 cluster.vertices[name >> 16 & 0xFF]};
      append_triangle(screen, wanted, {{v[0], v[1], v[2]}, first_number + (name >> 24)},
                      centres_in_box(v[0], v[1], v[2], screen), false, result);
    }
  }
  const std::uint64_t in = places.end - places.begin;
  result.counts.in += in;
  result.counts.culled += in - kept;
  result.counts.rasterized += kept;

  // The worst that may follow, and a vector more.
  const std::size_t most = result.fragments + small.size * kSmallSide * kSmallSide + kMostLanes;
  if (result.address.size() < most) {
    result.address.resize(2 * most);
    result.code.resize(2 * most);
    result.number.resize(2 * most);
  }
  for (std::size_t i = 0; i < small.size; i += lanes)
    draw_small(cluster, small, i, std::min(lanes, small.size - i), first_number, result);
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(set_up_compact);

namespace {

void append_blended(const Screen& screen, const geometry::Rect& wanted,
                    const ScreenTriangle& triangle, const geometry::Rect& box,
                    SetUpResult& result) {
  const geometry::Rect pixels = geometry::intersection(box, wanted);
  if (pixels.empty()) return;
  const auto entry = static_cast<std::uint32_t>(result.blended_triangles.size());
  result.blended_triangles.push_back(triangle);
  for (int y = pixels.y0 / kTileSize; y <= (pixels.y1 - 1) / kTileSize; ++y)
    for (int x = pixels.x0 / kTileSize; x <= (pixels.x1 - 1) / kTileSize; ++x)
      result.blended_entries.push_back({static_cast<std::uint32_t>(y * screen.tiles_x + x), entry});
}

// One triangle after the other: clusters that are clipped, masked, blended or large on the screen.
void set_up_each(const Screen& screen, const PreparedDraw& draw, const ClusterBlock& block,
                 const Cluster& cluster, const ScreenVertices& vertices, std::uint32_t first_number,
                 const geometry::Rect& wanted, SetUpResult& result) {
  const MeshCluster& mesh_cluster = block.clusters[cluster.part];
  for (std::uint32_t place = cluster.begin; place < cluster.end; ++place) {
    bool handed = false;
    const auto emit = [&](const ScreenTriangle& triangle, const geometry::Rect& pixels) {
      if (draw.blended)
        append_blended(screen, wanted, triangle, pixels, result);
      else
        append_triangle(screen, wanted, triangle, pixels, draw.masked, result);
      handed |= !geometry::intersection(pixels, wanted).empty();
    };
    const Fate fate = set_up(screen, draw, vertices, corners_at(block, mesh_cluster, place),
                             cluster.first + place, first_number + place, emit);
    ++result.counts.in;
    result.counts.culled += fate == Fate::culled;
    result.counts.clipped += fate == Fate::clipped;
    result.counts.rasterized += handed;
  }
}

}  // namespace

void set_up_cluster(const Screen& screen, const PreparedDraw& draw, const ClusterBlock& block,
                    const Cluster& cluster, const ScreenVertices& vertices,
                    std::uint32_t first_number, const geometry::Rect& wanted, SetUpResult& result) {
  // Whole pixels, so that pixel centres are where they are in the frame.
  const int low_x = vertices.low_x >> kSubpixelBits, low_y = vertices.low_y >> kSubpixelBits;
  const int origin_x = low_x * kSubpixels, origin_y = low_y * kSubpixels;
  if (draw.masked || draw.blended || vertices.any_outside ||
      vertices.high_x - origin_x >= kCompact || vertices.high_y - origin_y >= kCompact) {
    set_up_each(screen, draw, block, cluster, vertices, first_number, wanted, result);
    return;
  }
  const MeshCluster& mesh_cluster = block.clusters[cluster.part];
  CompactCluster compact(vertices);
  compact.origin_x = low_x + screen.centre_x;
  compact.origin_y = low_y + screen.centre_y;
  compact.tiles_x = screen.tiles_x;
  compact.clip = {wanted.x0 - compact.origin_x, wanted.y0 - compact.origin_y,
                  wanted.x1 - compact.origin_x, wanted.y1 - compact.origin_y};
  for (std::size_t i = 0; i < mesh_cluster.vertices; ++i)
    compact.position[i] = (vertices.x[i] - origin_x) | (vertices.y[i] - origin_y) << 16;
  HWY_DYNAMIC_DISPATCH(set_up_compact)
  (screen, draw, block, mesh_cluster, cluster, compact, first_number, wanted, result);
}

}  // namespace delray::raster
#endif
