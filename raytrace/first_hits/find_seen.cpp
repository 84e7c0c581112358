// Finds where on the picture rays may hit triangles, for certain: nothing that Embree's arithmetic
// lets pass is left out, however rays and triangles are rounded.
//
// On the screen a ray passes the three edge functions only where no barycentric coordinate is below
// -b, b the largest error of an edge function over the doubled area (triangle_lanes.h), times the
// depths that perspective divides by: b = kNoise |D| e v z / |T|. For b <= 1/4 that is the triangle
// scaled about its centre by 1 + 3b, at most 2bl beyond its box, l its longest side. For larger b
// (slivers, triangles seen from the side) both signs have to be thought of: no coordinate is beyond
// 1 + 2b, which is (2 + 4b)l.
//
// A triangle whose corners all lie outside of one plane of the window's frustum, by the part m of
// the farthest corner's distance, is met by no ray if b(3/m + 6) < 1, b without |D| and with v for
// z: D = sum U_k v_k / T, of which the outer part is negative, so that the edge functions U_k of a
// passing ray sum up to 3/m errors at most, and D would be shorter than itself. Triangles that may
// be hit far beyond their boxes are hit along a line (seen_strip.cpp). Triangles without a normal
// are never hit, as the denominator of their depth is 0.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "raytrace/first_hits/seen_strip.h"
#include "raytrace/first_hits/triangle_bins.h"
#include "raytrace/scene/flush_to_zero.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/first_hits/find_seen.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

#include "raytrace/first_hits/triangle_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

HWY_INLINE void put_blocks(F v, std::int32_t* to, int i) {
  hn::Store(truncated(v), IntTag(), to + i);
}

// Which of the lanes are hit by no ray, as all their corners lie beyond one plane.
HWY_INLINE M lies_outside(const TriangleLanes& t, const SeenFrom& from) {
  F most = set(-1.0F);
  for (const glm::vec3& plane : from.planes) {
    const F3 out = set(plane);
    const F beyond =
        hn::Min(dot(t.corner[0], out), hn::Min(dot(t.corner[1], out), dot(t.corner[2], out)));
    most = hn::Max(most, beyond);
  }
  // 1 / 1024: the sides' own rounding.
  const float off = 0x1p-10F + 4.0F * from.space.off_angle;
  const F part = (most - set(4.0F * from.space.off_length)) / t.farthest - set(off);
  const F noise = set(kNoise) * t.longest * t.farthest * t.farthest;
  const M sure =
      hn::Lt(noise * (set(3.0F) + set(6.0F) * part), set(0.5F) * part * hn::Abs(t.depth));
  return hn::And(hn::Gt(part, set(0.0F)), sure);
}

// Boxes of blocks, where they are within the window.
struct Boxes {
  HWY_ALIGN std::int32_t x0[kPacketRays], y0[kPacketRays], x1[kPacketRays], y1[kPacketRays];
  shading::Floats16 nearest;
  shading::LaneMask within = 0;
};
// Returns the lanes that cannot be hit outside.
HWY_INLINE shading::LaneMask find_boxes(const TriangleLanes& t, const SeenFrom& from, int i,
                                        Boxes& boxes) {
  const RaySpace& space = from.space;
  const F scale = set(from.scale), zero = set(0.0F);
  F low_x = set(1e30F), high_x = set(-1e30F), low_y = low_x, high_y = high_x;
  F deepest = zero, steepest = zero, nearest = set(1e30F), depth = set(1e30F);
  M before = hn::Eq(zero, zero);
  for (const F3& corner : t.corner) {
    const F z = dot(corner, set(space.forward));
    const F square = dot(corner, corner) * set(space.forward_length * space.forward_length);
    before = hn::And(before, hn::And(hn::Gt(z, zero), hn::Ge(z * z, square * set(0x1p-20F))));
    const F over = set(1.0F) / z;
    const F x = set(from.half_width) + dot(corner, set(space.right)) * over * scale;
    const F y = set(from.half_height) - dot(corner, set(space.up)) * over * scale;
    low_x = hn::Min(low_x, x), high_x = hn::Max(high_x, x);
    low_y = hn::Min(low_y, y), high_y = hn::Max(high_y, y);
    deepest = hn::Max(deepest, z);
    depth = hn::Min(depth, z);
    steepest = hn::Max(steepest, square * over * over);
    nearest = hn::Min(nearest, dot(corner, corner));
  }
  const F noise = set(kNoise * space.longest) * t.longest * t.farthest * deepest / hn::Abs(t.depth);
  const F side = (high_x - low_x) + (high_y - low_y);
  const F two = set(2.0F), four = set(4.0F);
  const F grown = hn::IfThenElse(hn::Le(noise, set(0.25F)), two * noise, four * noise + two) * side;
  const F off = set(space.off_angle) + set(space.off_length) / hn::Sqrt(nearest);
  const F margin = grown + set(from.margin) + scale * steepest * (set(0x1p-20F) + four * off);
  // Written so that what is not a number fails.
  const M known = hn::And(before, hn::Le(margin, set(kWidest)));
  // Between corners 1 / t is a plane, and beyond them as far as its barycentric coordinates go.
  const M bounded =
      hn::And(hn::And(known, is_firm(t, space, deepest)), hn::Le(noise, set(0x1p-4F)));
  hn::Store(hn::IfThenElseZero(bounded, depth * (set(0.999F) - four * noise)), FloatTag(),
            boxes.nearest.lane + i);
  // The window's pixels of the box, and their blocks.
  const F x0 = hn::Max(hn::Ceil(low_x - margin - set(from.first)), set(from.x0));
  const F y0 = hn::Max(hn::Ceil(low_y - margin - set(from.first)), set(from.y0));
  const F x1 = hn::Min(hn::Floor(high_x + margin + set(from.last)), set(from.x1));
  const F y1 = hn::Min(hn::Floor(high_y + margin + set(from.last)), set(from.y1));
  const F side_of_block = set(1.0F / kBlockSide), one = set(1.0F);
  put_blocks((x0 - set(from.x0)) * side_of_block, boxes.x0, i);
  put_blocks((y0 - set(from.y0)) * side_of_block, boxes.y0, i);
  put_blocks((x1 - set(from.x0)) * side_of_block + one, boxes.x1, i);
  put_blocks((y1 - set(from.y0)) * side_of_block + one, boxes.y1, i);
  boxes.within |= bits_of(hn::And(hn::Le(x0, x1), hn::Le(y0, y1)), i);
  return bits_of(known, i);
}

// Squares of triangles, side by side.
struct SquareLanes {
  static constexpr int kMost = (4 + 1) * kPacketRays;
  HWY_ALIGN std::int32_t square[kMost], triangle[kMost], blocks[kMost];
  HWY_ALIGN float nearest[kMost];
  int size = 0;
};

// Appends the squares of those of lanes i, i + 1, ... that lie in no more than two columns and two
// rows of them; lane 0 is triangle `first`. Returns those lanes. Without branches, as it cannot be
// foreseen how many squares a triangle lies in.
HWY_INLINE shading::LaneMask put_squares(const Boxes& boxes, shading::LaneMask seen, int i,
                                         std::uint32_t first, std::int32_t columns,
                                         SquareLanes& to) {
  static_assert(kBinBlocks == 4 && kSquareBlocks == 16);
  const IntTag d;
  const I zero = hn::Zero(d), one = hn::Set(d, 1), side = hn::Set(d, kBinBlocks);
  const I x0 = hn::Load(d, boxes.x0 + i), y0 = hn::Load(d, boxes.y0 + i);
  const I x1 = hn::Load(d, boxes.x1 + i), y1 = hn::Load(d, boxes.y1 + i);
  const I left = hn::ShiftRight<2>(x0), right = hn::ShiftRight<2>(x1 - one);
  const I top = hn::ShiftRight<2>(y0), bottom = hn::ShiftRight<2>(y1 - one);
  const auto many = hn::Or(hn::Gt(right - left, one), hn::Gt(bottom - top, one));
  const auto few = hn::AndNot(many, hn::RebindMask(d, mask_of(seen, i)));
  const I triangle = hn::Iota(d, static_cast<std::int32_t>(first) + i);
  const F nearest = load(boxes.nearest, i);
  for (int s = 0; s < 4; ++s) {
    auto its = few;
    if (s % 2 == 1) its = hn::And(its, hn::Gt(right, left));
    if (s / 2 == 1) its = hn::And(its, hn::Gt(bottom, top));
    const I column = left + hn::Set(d, s % 2), row = top + hn::Set(d, s / 2);
    const I first_x = hn::ShiftLeft<2>(column), first_y = hn::ShiftLeft<2>(row);
    const auto within = [&](I block) { return hn::Min(hn::Max(block, zero), side); };
    const I low_x = within(x0 - first_x), high_x = within(x1 - first_x);
    const I low_y = within(y0 - first_y), high_y = within(y1 - first_y);
    // A bit for the first block of each row, times the bits of a row.
    const auto between = [&](I low, I high) { return hn::Shl(one, high) - hn::Shl(one, low); };
    const I rows = hn::Set(d, 0x1111) & between(hn::ShiftLeft<2>(low_y), hn::ShiftLeft<2>(high_y));
    const I count = (high_x - low_x) * (high_y - low_y);
    const I blocks = rows * between(low_x, high_x) + hn::ShiftLeft<kSquareBlocks>(count);
    const int n = to.size;
    hn::StoreU(hn::Compress(row * hn::Set(d, columns) + column, its), d, to.square + n);
    hn::StoreU(hn::Compress(triangle, its), d, to.triangle + n);
    hn::StoreU(hn::Compress(nearest, hn::RebindMask(FloatTag(), its)), FloatTag(), to.nearest + n);
    hn::StoreU(hn::Compress(blocks, its), d, to.blocks + n);
    to.size += static_cast<int>(hn::CountTrue(d, its));
  }
  return bits_of(hn::RebindMask(FloatTag(), few), i);
}

void append(const SquareLanes& from, std::vector<TriangleInSquare>& to) {
  static_assert(sizeof(TriangleInSquare) == 16);
  const IntTag d;
  const std::size_t before = to.size(), size = static_cast<std::size_t>(from.size);
  const auto step = static_cast<std::size_t>(lanes());
  to.resize(before + (size + step - 1) / step * step);
  for (std::size_t i = 0; i < size; i += step) {
    hn::StoreInterleaved4(hn::Load(d, from.square + i), hn::Load(d, from.triangle + i),
                          hn::BitCast(d, hn::Load(FloatTag(), from.nearest + i)),
                          hn::Load(d, from.blocks + i), d,
                          reinterpret_cast<std::int32_t*>(to.data() + before + i));
  }
  to.resize(before + size);
}

// Lanes that can be hit at all, and those of them that may be hit outside of their boxes.
struct SeenLanes {
  shading::LaneMask seen = 0, beyond = 0;
};
SeenLanes find_boxes_of(const CornerLanes& corners, const SeenFrom& from, Boxes& boxes) {
  SeenLanes result;
  boxes.within = 0;
  for (int i = 0; i < kPacketRays; i += lanes()) {
    F3 position[3];
    load_corners(corners, i, position);
    const TriangleLanes t = triangles_of(position, from.space.origin);
    const F sum = hn::Abs(t.normal.x) + hn::Abs(t.normal.y) + hn::Abs(t.normal.z);
    const M flat = hn::Eq(sum, set(0.0F));
    const M out = hn::Or(flat, lies_outside(t, from));
    const shading::LaneMask seen = bits_of(hn::Not(out), i);
    result.seen |= seen;
    result.beyond |= seen & ~find_boxes(t, from, i, boxes);
  }
  return result;
}

std::array<glm::vec3, 3> corners_of(const CornerLanes& corners, int k) {
  std::array<glm::vec3, 3> result;
  for (int c = 0; c < 3; ++c) {
    result[c] = {corners.value[3 * c][k], corners.value[3 * c + 1][k], corners.value[3 * c + 2][k]};
  }
  return result;
}

void find_seen_of(const GeometryInstance& instance, const SeenFrom& from, std::uint32_t first,
                  std::uint32_t last, SeenTriangles& seen) {
  const FlushToZero flush;
  CornerLanes corners;
  for (int k = 0; k < kPacketRays; ++k) clear_corners(k, corners);
  Boxes boxes;
  seen.in_squares.reserve(last - first);
  const int columns = squares_along(from.window.width());
  F nearest = set(seen.nearest);
  for (std::uint32_t begin = first; begin < last; begin += kPacketRays) {
    const std::uint32_t count = std::min<std::uint32_t>(kPacketRays, last - begin);
    for (std::uint32_t k = 0; k < count; ++k) {
      set_corners(instance.positions, instance.mesh->triangles[begin + k], static_cast<int>(k),
                  corners);
    }
    SeenLanes found = find_boxes_of(corners, from, boxes);
    found.seen &= (1U << count) - 1U;
    const shading::LaneMask boxed = found.seen & ~found.beyond & boxes.within;
    shading::LaneMask few = 0;
    SquareLanes squares;
    for (int i = 0; i < kPacketRays; i += lanes()) {
      nearest =
          hn::IfThenElse(mask_of(boxed, i), hn::Min(nearest, load(boxes.nearest, i)), nearest);
      few |= put_squares(boxes, boxed, i, begin, columns, squares);
    }
    append(squares, seen.in_squares);
    for (shading::LaneMask rest = (boxed | (found.seen & found.beyond)) & ~few; rest != 0;
         rest &= rest - 1) {
      const int k = std::countr_zero(rest);
      WideTriangle triangle{begin + static_cast<std::uint32_t>(k)};
      if ((found.beyond >> k & 1) != 0) {
        nearest = set(0.0F);
        find_strip(corners_of(corners, k), from, triangle, seen.wide);
        continue;
      }
      triangle.nearest = boxes.nearest[k];
      triangle.x0 = static_cast<std::uint16_t>(boxes.x0[k]);
      triangle.y0 = static_cast<std::uint16_t>(boxes.y0[k]);
      triangle.x1 = static_cast<std::uint16_t>(boxes.x1[k]);
      triangle.y1 = static_cast<std::uint16_t>(boxes.y1[k]);
      seen.wide.push_back(triangle);
    }
  }
  seen.nearest = hn::GetLane(hn::MinOfLanes(FloatTag(), nearest));
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {

HWY_EXPORT(find_seen_of);

namespace {

// Pixels by which a ray may pass beside its place: a component of its direction may be moved off 0
// by a millionth of its length (primary_rays.h).
float ray_margin(const SeenWindow& window) {
  return 0.02F + 4e-6F * window.view.scale * window.longest * window.longest;
}

SeenFrom seen_from(const RaySpace& space, const SeenWindow& window) {
  const scenes::View& view = window.view;
  const geometry::Rect& pixels = window.pixels;
  SeenFrom from{space,
                {},
                view.scale,
                view.half_width,
                view.half_height,
                ray_margin(window),
                window.centred ? 0.5F : 1.0F,
                window.centred ? -0.5F : 0.0F,
                static_cast<float>(pixels.x0),
                static_cast<float>(pixels.y0),
                static_cast<float>(pixels.x1 - 1),
                static_cast<float>(pixels.y1 - 1),
                pixels};
  const auto place_x = [&](int x) {
    return (static_cast<float>(x) - view.half_width) / view.scale;
  };
  const auto place_y = [&](int y) {
    return (static_cast<float>(y) - view.half_height) / view.scale;
  };
  const auto plane = [](const glm::vec3& v) { return v * (1.0F / glm::length(v)); };
  from.planes[0] = plane(space.forward * place_x(pixels.x0 - 1) - space.right);
  from.planes[1] = plane(space.right - space.forward * place_x(pixels.x1 + 1));
  from.planes[2] = plane(space.forward * place_y(pixels.y0 - 1) + space.up);
  from.planes[3] = plane(-space.up - space.forward * place_y(pixels.y1 + 1));
  from.planes[4] = plane(-space.forward);
  return from;
}

}  // namespace

SeenTriangles find_seen(const GeometryInstance& instance, std::uint32_t number,
                        const RaySpace& space, const SeenWindow& window, std::uint32_t first,
                        std::uint32_t last) {
  SeenTriangles seen;
  seen.instance = number;
  HWY_DYNAMIC_DISPATCH(find_seen_of)(instance, seen_from(space, window), first, last, seen);
  return seen;
}

}  // namespace delray::raytrace
#endif
