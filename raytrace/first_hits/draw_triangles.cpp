// Object order instead of ray order: triangles are set up sixteen at a time, then each is tested
// against its blocks of rays, "3D rasterization" (Davidovic et al. 2012). With one origin of all
// rays the normals of the edges' planes are the triangle's, so that a ray takes four scalar
// products.
//
// A hit is certain where it is safely inside of its triangle, where the next one is further by more
// than depths may be off, and where no triangle passed of which nothing is certain: Embree cannot
// have found another one, as all that its arithmetic lets pass were drawn, nor can it have left out
// this one, as the boxes around a point inside a triangle are met with the rounding that they are
// tested with. Everything else is left to Embree: edges, corners and silhouettes, surfaces that lie
// in each other, and triangles seen from the side.
#include "raytrace/first_hits/draw_triangles.h"

#include <algorithm>
#include <limits>

#include "raytrace/scene/edges.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/first_hits/draw_triangles.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

#include "raytrace/first_hits/triangle_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

// What is needed of triangles to test rays against them; lane i is triangle i.
struct SetUpTriangles {
  shading::Vectors16 plane[3];  // through the origin and an edge
  shading::Vectors16 normal;
  shading::Floats16 depth, margin;
  shading::LaneMask firm;
};

HWY_INLINE void put_lanes(F v, shading::Floats16& to, int i) {
  hn::Store(v, FloatTag(), to.lane + i);
}
HWY_INLINE void put_lanes(const F3& v, shading::Vectors16& to, int i) {
  put_lanes(v.x, to.x, i), put_lanes(v.y, to.y, i), put_lanes(v.z, to.z, i);
}

void set_up_triangles(const CornerLanes& corners, const RaySpace& space, SetUpTriangles& set_up) {
  set_up.firm = 0;
  for (int i = 0; i < kPacketRays; i += lanes()) {
    F3 position[3];
    load_corners(corners, i, position);
    const TriangleLanes t = triangles_of(position, space.origin);
    put_lanes(exact_cross(t.edge[0], t.corner[2] + t.corner[0]), set_up.plane[0], i);
    put_lanes(exact_cross(t.edge[1], t.corner[0] + t.corner[1]), set_up.plane[1], i);
    put_lanes(exact_cross(t.edge[2], t.corner[1] + t.corner[2]), set_up.plane[2], i);
    put_lanes(t.normal, set_up.normal, i);
    put_lanes(t.depth, set_up.depth, i);
    put_lanes(inside_margin(t, space), set_up.margin, i);
    F deepest = set(0.0F);
    for (const F3& corner : t.corner)
      deepest = hn::Max(deepest, hn::Abs(dot(corner, set(space.forward))));
    set_up.firm |= bits_of(is_firm(t, space, deepest), i);
  }
}

// One of the triangles that are set up.
struct DrawnTriangle {
  F3 plane[3], normal;
  F depth, margin;
  bool firm;
  std::uint32_t triangle, geometry, instance;  // as Embree names them
};

HWY_INLINE F3 lane_of(const shading::Vectors16& v, int k) {
  return {set(v.x[k]), set(v.y[k]), set(v.z[k])};
}

HWY_INLINE void put_numbers(std::uint32_t number, M mask, std::uint32_t* to) {
  const IntTag d;
  auto* at = reinterpret_cast<std::int32_t*>(to);
  const I v = hn::Set(d, static_cast<std::int32_t>(number));
  hn::Store(hn::IfThenElse(hn::RebindMask(d, mask), v, hn::Load(d, at)), d, at);
}
HWY_INLINE F load_floats(const float* from) { return hn::Load(FloatTag(), from); }
HWY_INLINE void put_some(F v, M mask, float* to) {
  hn::Store(hn::IfThenElse(mask, v, load_floats(to)), FloatTag(), to);
}

// A hit that is nearer than the next by less than this part may not be the one that Embree finds:
// twice what depths that are firm may be off.
constexpr float kTie = 1.0F + 0x1p-13F;

// Lanes i, i + 1, ... of a block.
struct DrawnLanes {
  DrawnBlock* block;
  int i;
};

HWY_INLINE F3 directions_of(const DrawnLanes& at, bool is_world) {
  if (!is_world) return load(at.block->direction, at.i);
  const RayPacket& packet = at.block->group->packet;
  return {load_floats(packet.direction_x + at.i), load_floats(packet.direction_y + at.i),
          load_floats(packet.direction_z + at.i)};
}

struct EdgeFunctions {
  F u, v, w, sum;
  M passes;
};
HWY_INLINE EdgeFunctions edge_functions(const DrawnTriangle& t, const F3& direction) {
  EdgeFunctions e{exact_dot(t.plane[0], direction),
                  exact_dot(t.plane[1], direction),
                  exact_dot(t.plane[2], direction),
                  {},
                  {}};
  e.sum = e.u + e.v + e.w;
  const F error = set(std::numeric_limits<float>::epsilon()) * hn::Abs(e.sum);
  const F least = hn::Min(e.u, hn::Min(e.v, e.w)), most = hn::Max(e.u, hn::Max(e.v, e.w));
  e.passes = hn::Or(hn::Ge(least, hn::Neg(error)), hn::Le(most, error));
  return e;
}

HWY_INLINE void find_beyond(DrawnBlock& block) {
  F most = set(0.0F);
  for (int i = 0; i < kPacketRays; i += lanes())
    most = hn::Max(most, load_floats(block.group->packet.far + i));
  block.came_nearer = false;
  block.beyond = kTie * hn::GetLane(hn::MaxOfLanes(FloatTag(), most));
}

// Of lanes of which some are within all edges.
void draw_lanes(const DrawnTriangle& t, const DrawnLanes& at, bool is_world) {
  const int i = at.i;
  DrawnBlock& block = *at.block;
  RayPacket& packet = block.group->packet;
  const F3 direction = directions_of(at, is_world);
  const EdgeFunctions e = edge_functions(t, direction);
  const F half = exact_dot(t.normal, direction);
  const F denominator = half + half;
  const F distance = exact_reciprocal(denominator) * t.depth;
  const F far = load_floats(packet.far + i);
  const F infinity = set(std::numeric_limits<float>::infinity());
  const M passes =
      hn::And(hn::And(e.passes, hn::Ne(denominator, set(0.0F))),
              hn::And(hn::Ge(distance, load_floats(packet.near + i)), hn::Le(distance, infinity)));
  if (!t.firm) {
    block.unsure |= bits_of(passes, i);
    return;
  }
  const F second = load(block.second, i);
  const F next = hn::Min(second, hn::Max(distance, far));
  hn::Store(hn::IfThenElse(passes, next, second), FloatTag(), block.second.lane + i);
  const M nearer = hn::And(passes, hn::Lt(distance, far));
  const shading::LaneMask now = bits_of(nearer, i);
  if (now == 0) return;

  const F inverse =
      hn::IfThenElseZero(hn::Ge(hn::Abs(e.sum), set(1e-18F)), exact_reciprocal(e.sum));
  const F one = set(1.0F);
  put_some(distance, nearer, packet.far + i);
  put_some(hn::Min(e.u * inverse, one), nearer, packet.u + i);
  put_some(hn::Min(e.v * inverse, one), nearer, packet.v + i);
  put_numbers(t.triangle, nearer, packet.triangle + i);
  put_numbers(t.geometry, nearer, packet.geometry + i);
  put_numbers(t.instance, nearer, packet.instance + i);
  const F inside = hn::Min(hn::Abs(e.u), hn::Min(hn::Abs(e.v), hn::Abs(e.w)));
  const shading::LaneMask safe = bits_of(hn::Gt(inside, t.margin), i);
  block.edge = (block.edge & ~now) | (now & ~safe);
  block.came_nearer = true;
}

template <int kCount>
HWY_INLINE void draw_at_once(const DrawnTriangle& t, const DrawnLanes* at, bool is_world) {
  shading::LaneMask passes[kCount];
  for (int k = 0; k < kCount; ++k)
    passes[k] = bits_of(edge_functions(t, directions_of(at[k], is_world)).passes, at[k].i);
  for (int k = 0; k < kCount; ++k) {
    if (passes[k] != 0) draw_lanes(t, at[k], is_world);
  }
}

// A triangle into all of its blocks that do not hide it, some at a time: edge functions of several
// blocks are computed before any of them is looked at, as what they are cannot be foreseen.
HWY_INLINE void draw_triangle(const DrawnTriangle& t, const SeenTriangle& seen, bool is_world,
                              const DrawnBlocks& blocks) {
  const int x0 = std::max(0, seen.x0 - blocks.x0), y0 = std::max(0, seen.y0 - blocks.y0);
  const int x1 = std::min(blocks.columns, seen.x1 - blocks.x0);
  const int y1 = std::min(blocks.rows, seen.y1 - blocks.y0);
  constexpr int kAtOnce = 4;
  DrawnLanes at[kAtOnce];
  int count = 0;
  const auto draw = [&] {
    switch (count) {
      case 1:
        draw_at_once<1>(t, at, is_world);
        break;
      case 2:
        draw_at_once<2>(t, at, is_world);
        break;
      case 3:
        draw_at_once<3>(t, at, is_world);
        break;
      default:
        draw_at_once<kAtOnce>(t, at, is_world);
    }
    count = 0;
  };
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      DrawnBlock& block = blocks.blocks[static_cast<std::size_t>(y * blocks.columns + x)];
      if (seen.nearest > block.beyond) continue;
      for (int i = 0; i < kPacketRays; i += lanes()) {
        at[count++] = {&block, i};
        if (count == kAtOnce) draw();
      }
    }
  }
  if (count > 0) draw();
}

// Directions as Embree brings them to a space.
void find_directions(const RaySpace& space, const DrawnBlocks& blocks) {
  const F3 x = set(space.to_local[0]), y = set(space.to_local[1]), z = set(space.to_local[2]);
  for (DrawnBlock& block : blocks.blocks) {
    const RayPacket& packet = block.group->packet;
    for (int i = 0; i < kPacketRays; i += lanes()) {
      const F dx = load_floats(packet.direction_x + i), dy = load_floats(packet.direction_y + i);
      const F dz = load_floats(packet.direction_z + i);
      const auto moved = [&](F a, F b, F c) {
        return hn::MulAdd(dx, a, hn::MulAdd(dy, b, dz * c));
      };
      put_lanes({moved(x.x, y.x, z.x), moved(x.y, y.y, z.y), moved(x.z, y.z, z.z)}, block.direction,
                i);
    }
  }
}

void draw_triangles_of(std::span<const GeometryInstance> instances, const RaySpace& space,
                       std::span<const SeenTriangle> triangles, const DrawnBlocks& blocks) {
  if (!space.is_world) find_directions(space, blocks);
  CornerLanes corners;
  SetUpTriangles set_up;
  for (std::size_t begin = 0; begin < triangles.size(); begin += kPacketRays) {
    const std::size_t count = std::min<std::size_t>(kPacketRays, triangles.size() - begin);
    for (std::size_t k = 0; k < count; ++k) {
      const SeenTriangle& seen = triangles[begin + k];
      const GeometryInstance& instance = instances[seen.instance];
      set_corners(instance.positions, instance.mesh->triangles[seen.triangle], static_cast<int>(k),
                  corners);
    }
    for (std::size_t k = count; k < kPacketRays; ++k) clear_corners(static_cast<int>(k), corners);
    set_up_triangles(corners, space, set_up);
    for (std::size_t k = 0; k < count; ++k) {
      const SeenTriangle& seen = triangles[begin + k];
      const int lane = static_cast<int>(k);
      const DrawnTriangle t{{lane_of(set_up.plane[0], lane), lane_of(set_up.plane[1], lane),
                             lane_of(set_up.plane[2], lane)},
                            lane_of(set_up.normal, lane),
                            set(set_up.depth[lane]),
                            set(set_up.margin[lane]),
                            (set_up.firm >> k & 1) != 0,
                            seen.triangle,
                            space.is_world ? seen.instance : 0,
                            space.is_world ? kMiss : seen.instance};
      draw_triangle(t, seen, space.is_world, blocks);
    }
    for (DrawnBlock& block : blocks.blocks) {
      if (block.came_nearer) find_beyond(block);
    }
  }
}

bool keep_certain(DrawnBlock& block) {
  RayPacket& packet = block.group->packet;
  const shading::LaneMask active = active_lanes(block.group->active);
  shading::LaneMask certain = 0;
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const F far = load_floats(packet.far + i), second = load(block.second, i);
    const M missed = hn::Eq(far, set(std::numeric_limits<float>::infinity()));
    const F u = load_floats(packet.u + i), v = load_floats(packet.v + i);
    const F least = hn::Min(hn::Min(u, v), set(1.0F) - (u + v));
    const M apart = hn::And(hn::Ge(second, far * set(kTie)), hn::Ge(least, set(kNearEdge)));
    certain |= bits_of(missed, i) | (bits_of(apart, i) & ~block.edge);
  }
  if ((active & (~certain | block.unsure)) == 0) return true;
  for (int i = 0; i < kPacketRays; ++i) {
    packet.far[i] = std::numeric_limits<float>::infinity();
    packet.triangle[i] = packet.geometry[i] = packet.instance[i] = kMiss;
  }
  return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {

HWY_EXPORT(draw_triangles_of);
HWY_EXPORT(keep_certain);

void draw_triangles(std::span<const GeometryInstance> instances, const RaySpace& space,
                    std::span<const SeenTriangle> triangles, const DrawnBlocks& blocks) {
  HWY_DYNAMIC_DISPATCH(draw_triangles_of)(instances, space, triangles, blocks);
}

void clear_drawn(RayGroup& group, DrawnBlock& block) {
  block.group = &group;
  block.unsure = block.edge = 0;
  block.came_nearer = false;
  block.beyond = std::numeric_limits<float>::infinity();
  for (float& second : block.second.lane) second = block.beyond;
}

bool keep_certain_hits(DrawnBlock& block) { return HWY_DYNAMIC_DISPATCH(keep_certain)(block); }

}  // namespace delray::raytrace
#endif
