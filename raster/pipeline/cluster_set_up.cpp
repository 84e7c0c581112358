// Sets up the triangles of a cluster by vectors, one lane a triangle: edge functions (Pineda 1988),
// depth planes, boxes, culling.
//
// A cluster whose vertices lie close together on the screen has one origin, so that edge functions
// fit 32 bits and a position one word; in others each triangle has an origin of its own. Triangles
// are sorted by size: tiny ones become fragments at once, pixel by pixel over a vector of
// triangles; those that fit a window in one tile become windows; the rest is handed on. Cost: some
// nanoseconds a triangle and the pixels of its box.
//
// Degenerate: triangles without area, without a pixel centre in their box or behind what is drawn
// already are dropped; clusters that are clipped, masked or blended go triangle by triangle
// (set_up_place.h), as do triangles too wide for 32 bits.
#include "raster/pipeline/cluster_set_up.h"

#include <algorithm>

#include "raster/pipeline/set_up_place.h"
#include "raster/pipeline/visibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/pipeline/cluster_set_up.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

#include "raster/pipeline/small_triangles.h"
#include "raster/pipeline/triangle_lanes.h"

#ifndef DELRAY_RASTER_CLUSTER_SET_UP
#define DELRAY_RASTER_CLUSTER_SET_UP
namespace delray::raster {

// Triangles of which at most so many columns and rows of pixel centres lie in the box are drawn
// pixel by pixel, many triangles at a time.
inline constexpr int kSmallSide = 8;
// But not those whose box has more pixel centres than this and that fit a window.
inline constexpr int kTinyBox = 9;
// A cluster is compact if its coordinates, seen from its corner, are below this: edge functions
// then fit 32 bits, also 16 pixels beyond the corners, and a position fits one word.
inline constexpr int kCompact = 30000;
static_assert(std::int64_t{2} * kCompact * (kCompact + 16 * kSubpixels) < INT32_MAX);

}  // namespace delray::raster
#endif

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Corners of triangles and where they are, seen from the origin, by coordinates and in one word
// each, x | y << 16.
struct PlacedTriangles {
  Origins origin;
  I ax, ay, bx, by, cx, cy;
  I a, b, c;
};

HWY_INLINE PlacedTriangles place_compact(const ClusterInSetUp& cluster, const Corners& corners) {
  const Ints d;
  PlacedTriangles t;
  t.origin = {hn::Set(d, cluster.origin_x), hn::Set(d, cluster.origin_y)};
  t.a = hn::GatherIndex(d, cluster.position, corners.a);
  t.b = hn::GatherIndex(d, cluster.position, corners.b);
  t.c = hn::GatherIndex(d, cluster.position, corners.c);
  t.ax = low_half(t.a), t.ay = high_half(t.a);
  t.bx = low_half(t.b), t.by = high_half(t.b);
  t.cx = low_half(t.c), t.cy = high_half(t.c);
  return t;
}

// Each from an origin of its own. Meaningless where a triangle is too wide.
HWY_INLINE PlacedTriangles place_wide(const ClusterInSetUp& cluster, const Corners& corners,
                                      Mask& too_wide) {
  const Ints d;
  const ScreenVertices& vertices = cluster.vertices;
  PlacedTriangles t;
  t.ax = hn::GatherIndex(d, vertices.x, corners.a),
  t.ay = hn::GatherIndex(d, vertices.y, corners.a);
  t.bx = hn::GatherIndex(d, vertices.x, corners.b),
  t.by = hn::GatherIndex(d, vertices.y, corners.b);
  t.cx = hn::GatherIndex(d, vertices.x, corners.c),
  t.cy = hn::GatherIndex(d, vertices.y, corners.c);
  const I low_x = hn::ShiftRight<kSubpixelBits>(hn::Min(hn::Min(t.ax, t.bx), t.cx));
  const I low_y = hn::ShiftRight<kSubpixelBits>(hn::Min(hn::Min(t.ay, t.by), t.cy));
  const I first_x = hn::ShiftLeft<kSubpixelBits>(low_x);
  const I first_y = hn::ShiftLeft<kSubpixelBits>(low_y);
  t.origin = {hn::Add(low_x, hn::Set(d, cluster.centre_x)),
              hn::Add(low_y, hn::Set(d, cluster.centre_y))};
  t.ax = hn::Sub(t.ax, first_x), t.bx = hn::Sub(t.bx, first_x), t.cx = hn::Sub(t.cx, first_x);
  t.ay = hn::Sub(t.ay, first_y), t.by = hn::Sub(t.by, first_y), t.cy = hn::Sub(t.cy, first_y);
  const I farthest =
      hn::Max(hn::Max(hn::Max(t.ax, t.ay), hn::Max(t.bx, t.by)), hn::Max(t.cx, t.cy));
  too_wide = hn::Gt(farthest, hn::Set(d, kCompact - 1));
  t.a = hn::Or(t.ax, hn::ShiftLeft<16>(t.ay));
  t.b = hn::Or(t.bx, hn::ShiftLeft<16>(t.by));
  t.c = hn::Or(t.cx, hn::ShiftLeft<16>(t.cy));
  return t;
}

// Sets up the triangles at some places one by one, and returns how many these are.
HWY_INLINE std::size_t set_up_alone(const ClusterInSetUp& cluster, I places, Mask alone,
                                    SetUpResult& result) {
  const Ints d;
  if (hn::AllFalse(d, alone)) return 0;
  HWY_ALIGN std::int32_t which[kMostLanes];
  append(places, alone, which);
  const std::size_t count = hn::CountTrue(d, alone);
  for (std::size_t k = 0; k < count; ++k)
    set_up_place(cluster.wanted, static_cast<std::uint32_t>(which[k]), result);
  return count;
}

// The lanes of `keep` that are hidden: the pixels of their boxes, in the frame, show what is
// nearer.
HWY_INLINE Mask hidden_of(const ClusterInSetUp& cluster, Mask keep, const Corners& corners,
                          const Boxes& pixels) {
  static_assert(VisibilityTile::kBlockWidth == 16 && VisibilityTile::kBlockHeight == 8);
  const Ints d;
  const Floats df;
  const DepthsAround& around = cluster.around;
  const I block_x = hn::ShiftRight<4>(pixels.x0), block_y = hn::ShiftRight<3>(pixels.y0);
  const I one = hn::Set(d, 1);
  const Mask many = hn::Or(hn::Gt(hn::ShiftRight<4>(pixels.x1), hn::Add(block_x, one)),
                           hn::Gt(hn::ShiftRight<3>(pixels.y1), hn::Add(block_y, one)));
  const Mask known = hn::AndNot(many, keep);
  if (hn::AllFalse(d, known)) return known;
  const I place =
      hn::Add(hn::Mul(hn::Sub(block_y, hn::Set(d, around.y0)), hn::Set(d, around.width)),
              hn::Sub(block_x, hn::Set(d, around.x0)));
  const I farthest = hn::GatherIndex(d, around.farthest, hn::IfThenElseZero(known, place));
  const float* depths = cluster.vertices.depth;
  const F nearest = hn::Min(
      hn::Min(hn::GatherIndex(df, depths, corners.a), hn::GatherIndex(df, depths, corners.b)),
      hn::GatherIndex(df, depths, corners.c));
  return hn::And(known, hn::Gt(hn::Not(hn::BitCast(d, nearest)), farthest));
}

// How triangles are drawn: those of a few pixels pixel by pixel, those that are wider window by
// window if they lie in one tile; others are handed on.
struct SizeMasks {
  Mask small, medium;
};
HWY_INLINE SizeMasks sizes_of(I columns, I rows, const Boxes& pixels, Mask keep,
                              Mask windows_wanted) {
  const Ints d;
  const I small_side = hn::Set(d, kSmallSide);
  const I border = hn::Or(hn::Xor(pixels.x0, pixels.x1), hn::Xor(pixels.y0, pixels.y1));
  const Mask tiny = hn::Lt(hn::Add(hn::Mul(columns, rows), hn::Add(columns, rows)),
                           hn::Set(d, kTinyBox));  // (columns + 1) * (rows + 1) - 1
  const Mask fits = hn::And(hn::And(hn::Lt(columns, hn::Set(d, WindowTriangles::kMostColumns)),
                                    hn::Lt(rows, hn::Set(d, WindowTriangles::kMostRows))),
                            hn::Lt(border, hn::Set(d, kTileSize)));
  SizeMasks sizes;
  sizes.medium = hn::And(hn::AndNot(tiny, hn::And(keep, fits)), windows_wanted);
  sizes.small = hn::AndNot(
      sizes.medium, hn::And(keep, hn::And(hn::Lt(columns, small_side), hn::Lt(rows, small_side))));
  return sizes;
}

// Triangles whose corners run clockwise, in the order of SmallTriangles::corners.
struct ClockwiseTriangles {
  Origins origin;
  I a, b, c;  // positions
  I corners;
};
HWY_INLINE ClockwiseTriangles turn(const PlacedTriangles& t, const Corners& corners, Mask counter,
                                   I places) {
  const I b = hn::IfThenElse(counter, corners.c, corners.b);
  const I c = hn::IfThenElse(counter, corners.b, corners.c);
  return {t.origin, t.a, hn::IfThenElse(counter, t.c, t.b), hn::IfThenElse(counter, t.b, t.c),
          hn::Or(hn::Or(corners.a, hn::ShiftLeft<8>(b)),
                 hn::Or(hn::ShiftLeft<16>(c), hn::ShiftLeft<24>(places)))};
}

HWY_INLINE void append_to(SmallTriangles& triangles, const ClockwiseTriangles& t, Mask mask) {
  const Ints d;
  append(t.a, mask, triangles.a + triangles.size);
  append(t.b, mask, triangles.b + triangles.size);
  append(t.c, mask, triangles.c + triangles.size);
  append(t.corners, mask, triangles.corners + triangles.size);
  append(t.origin.x, mask, triangles.origin_x + triangles.size);
  append(t.origin.y, mask, triangles.origin_y + triangles.size);
  triangles.size += hn::CountTrue(d, mask);
}

// Hands on triangles that are neither small nor medium, to be drawn tile by tile.
HWY_INLINE void hand_on(const ClusterInSetUp& cluster, I corners, Mask others,
                        SetUpResult& result) {
  const Ints d;
  if (hn::AllFalse(d, others)) return;
  HWY_ALIGN std::int32_t which[kMostLanes];
  append(corners, others, which);
  const std::size_t count = hn::CountTrue(d, others);
  const ScreenVertices& vertices = cluster.vertices;
  for (std::size_t k = 0; k < count; ++k) {
    const auto name = static_cast<std::uint32_t>(which[k]);
    const ScreenVertex v[3] = {vertices[name & 0xFF], vertices[name >> 8 & 0xFF],
                               vertices[name >> 16 & 0xFF]};
    append_triangle(cluster.wanted, {{v[0], v[1], v[2]}, cluster.first_number + (name >> 24)},
                    centres_in_box(v[0], v[1], v[2], cluster.wanted.on_screen.screen), result);
  }
}

HWY_INLINE void draw_sorted(const ClusterInSetUp& cluster, const SmallTriangles& small,
                            const SmallTriangles& medium, SetUpResult& result) {
  const std::size_t lanes = hn::Lanes(Ints());
  // The worst that may follow, and a vector more.
  const std::size_t most = result.fragments + small.size * kSmallSide * kSmallSide + kMostLanes;
  if (result.address.size() < most) {
    result.address.resize(2 * most);
    result.code.resize(2 * most);
    result.number.resize(2 * most);
  }
  result.windows.reserve(result.windows.size + medium.size + kMostLanes);
  for (std::size_t i = 0; i < medium.size; i += lanes)
    set_up_windows(cluster, medium, i, std::min(lanes, medium.size - i), result.windows);
  for (std::size_t i = 0; i < small.size; i += lanes)
    draw_small(cluster, small, i, std::min(lanes, small.size - i), result);
}

enum class Extent : bool { compact, wide };

template <Extent extent>
void set_up_vectors(const ClusterInSetUp& cluster, SetUpResult& result) {
  const ClusterToSetUp& wanted = cluster.wanted;
  const MeshCluster& mesh_cluster = wanted.on_screen.cluster;
  const Ints d;
  const std::size_t lanes = hn::Lanes(d);
  const std::uint8_t* all_corners =
      wanted.on_screen.block.corners.data() + mesh_cluster.first_corner;
  const std::size_t stride = mesh_cluster.corner_stride();
  const int hidden_side = wanted.on_screen.draw.hidden_side;
  const auto begin = static_cast<std::int32_t>(wanted.begin);
  const auto end = static_cast<std::int32_t>(wanted.end);
  SmallTriangles small, medium;
  const Mask windows_wanted = hn::FirstN(d, result.fragments_only ? 0 : lanes);
  const I zero = hn::Zero(d);
  std::size_t kept = 0, alone = 0;
  for (std::size_t place = wanted.begin / lanes * lanes; place < wanted.end; place += lanes) {
    // Iota of a constant: of a variable, lanes would be filled one by one.
    const I places = hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<std::int32_t>(place)));
    const Corners corners = load_corners(all_corners, stride, place);
    Mask in_range = hn::And(hn::Gt(places, hn::Set(d, begin - 1)), hn::Lt(places, hn::Set(d, end)));
    PlacedTriangles t;
    if constexpr (extent == Extent::compact) {
      t = place_compact(cluster, corners);
    } else {
      Mask too_wide;
      t = place_wide(cluster, corners, too_wide);
      alone += set_up_alone(cluster, places, hn::And(in_range, too_wide), result);
      in_range = hn::AndNot(too_wide, in_range);
    }
    const Boxes box = boxes_of(cluster.clip, t.origin, t.ax, t.ay, t.bx, t.by, t.cx, t.cy);
    const I columns = hn::Sub(box.x1, box.x0), rows = hn::Sub(box.y1, box.y0);
    const I area = hn::Sub(hn::Mul(hn::Sub(t.bx, t.ax), hn::Sub(t.cy, t.ay)),
                           hn::Mul(hn::Sub(t.cx, t.ax), hn::Sub(t.by, t.ay)));
    const Mask clockwise = hn::Gt(area, zero), counter = hn::Lt(area, zero);
    const Mask shown = shown_of(hidden_side, clockwise, counter);
    Mask keep = hn::And(hn::And(hn::Gt(hn::Or(columns, rows), hn::Set(d, -1)), shown), in_range);
    kept += hn::CountTrue(d, keep);
    const Boxes pixels = {hn::Add(box.x0, t.origin.x), hn::Add(box.y0, t.origin.y),
                          hn::Add(box.x1, t.origin.x), hn::Add(box.y1, t.origin.y)};
    if (cluster.around.may_hide) keep = hn::AndNot(hidden_of(cluster, keep, corners, pixels), keep);
    if (hn::AllFalse(d, keep)) continue;
    const SizeMasks sizes = sizes_of(columns, rows, pixels, keep, windows_wanted);
    const ClockwiseTriangles turned = turn(t, corners, counter, places);
    append_to(small, turned, sizes.small);
    if (!hn::AllFalse(d, sizes.medium)) append_to(medium, turned, sizes.medium);
    hand_on(cluster, turned.corners, hn::AndNot(hn::Or(sizes.small, sizes.medium), keep), result);
  }
  const std::uint64_t in = wanted.end - wanted.begin - alone;
  result.counts.in += in;
  result.counts.culled += in - kept;
  result.counts.rasterized += kept;
  draw_sorted(cluster, small, medium, result);
}

void set_up_compact(const ClusterInSetUp& cluster, SetUpResult& result) {
  set_up_vectors<Extent::compact>(cluster, result);
}
void set_up_wide(const ClusterInSetUp& cluster, SetUpResult& result) {
  set_up_vectors<Extent::wide>(cluster, result);
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(set_up_compact);
HWY_EXPORT(set_up_wide);

void set_up_cluster(const ClusterToSetUp& cluster, const FrameTiles& tiles, SetUpResult& result) {
  const ScreenVertices& vertices = cluster.on_screen.vertices;
  const PreparedDraw& draw = cluster.on_screen.draw;
  if (draw.masked || draw.blended || vertices.any_outside) {
    for (std::uint32_t place = cluster.begin; place < cluster.end; ++place)
      set_up_place(cluster, place, result);
    return;
  }
  ClusterInSetUp in_set_up(cluster);
  const Screen& screen = cluster.on_screen.screen;
  const auto pixel = [](std::int32_t coordinate, int centre) {
    return (coordinate >> kSubpixelBits) + centre;
  };
  tiles.look_around(geometry::intersection({pixel(vertices.low_x, screen.centre_x),
                                            pixel(vertices.low_y, screen.centre_y),
                                            pixel(vertices.high_x, screen.centre_x) + 1,
                                            pixel(vertices.high_y, screen.centre_y) + 1},
                                           cluster.clip),
                    vertices.farthest, in_set_up.around);
  // Whole pixels, so that pixel centres are where they are in the frame.
  const int low_x = vertices.low_x >> kSubpixelBits, low_y = vertices.low_y >> kSubpixelBits;
  const int origin_x = low_x * kSubpixels, origin_y = low_y * kSubpixels;
  if (vertices.high_x - origin_x >= kCompact || vertices.high_y - origin_y >= kCompact) {
    HWY_DYNAMIC_DISPATCH(set_up_wide)(in_set_up, result);
    return;
  }
  in_set_up.origin_x = low_x + screen.centre_x;
  in_set_up.origin_y = low_y + screen.centre_y;
  for (std::size_t i = 0; i < cluster.on_screen.cluster.vertices; ++i)
    in_set_up.position[i] = (vertices.x[i] - origin_x) | (vertices.y[i] - origin_y) << 16;
  HWY_DYNAMIC_DISPATCH(set_up_compact)(in_set_up, result);
}

}  // namespace delray::raster
#endif
