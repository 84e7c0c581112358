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
#include <bit>
#include <limits>

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
  shading::Floats16 depth, margin[3];  // of edges: inside_margin
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
    const F off = off_at_box(position, t, space);
    for (int e = 0; e < 3; ++e) put_lanes(inside_margin(t, e, off, space), set_up.margin[e], i);
    F deepest = set(0.0F);
    for (const F3& corner : t.corner)
      deepest = hn::Max(deepest, hn::Abs(dot(corner, set(space.forward))));
    set_up.firm |= bits_of(is_firm(t, space, deepest), i);
  }
}

// Sixteen triangles of a space, and the blocks that each is to be drawn into.
struct DrawnBatch {
  const BinnedTriangle* triangle[kPacketRays];
  shading::LaneMask blocks[kPacketRays];
  int size = 0;
};

// A triangle of a batch and a block of the square, as one number.
HWY_INLINE int triangle_of(std::int32_t pair) { return pair / kSquareBlocks; }
HWY_INLINE int block_of(std::int32_t pair) { return pair % kSquareBlocks; }

// All of the batch, without branches, as their numbers cannot be foreseen.
struct DrawnPairs {
  HWY_ALIGN std::int32_t pair[kPacketRays * kSquareBlocks + kPacketRays];
  int size = 0;
};
HWY_INLINE void list_pairs(const DrawnBatch& batch, DrawnPairs& pairs) {
  const IntTag d;
  pairs.size = 0;
  for (int k = 0; k < batch.size; ++k) {
    for (int i = 0; i < kSquareBlocks; i += lanes()) {
      const auto mask = hn::RebindMask(d, mask_of(batch.blocks[k], i));
      const I all = hn::Iota(d, kSquareBlocks * k + i);
      hn::StoreU(hn::Compress(all, mask), d, pairs.pair + pairs.size);
      pairs.size += std::popcount(batch.blocks[k] >> i & shading::first_lanes(lanes()));
    }
  }
}

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
// Barycentric: nor one that is nearer to an edge.
constexpr float kOnEdge = 1e-5F;

struct EdgeFunctions {
  F u, v, w, sum;
  M passes;
};
HWY_INLINE EdgeFunctions edge_functions(const SetUpTriangles& t, int k, const F3& direction) {
  EdgeFunctions e{exact_dot(lane_of(t.plane[0], k), direction),
                  exact_dot(lane_of(t.plane[1], k), direction),
                  exact_dot(lane_of(t.plane[2], k), direction),
                  {},
                  {}};
  e.sum = e.u + e.v + e.w;
  const F error = set(std::numeric_limits<float>::epsilon()) * hn::Abs(e.sum);
  const F least = hn::Min(e.u, hn::Min(e.v, e.w)), most = hn::Max(e.u, hn::Max(e.v, e.w));
  e.passes = hn::Or(hn::Ge(least, hn::Neg(error)), hn::Le(most, error));
  return e;
}

// As Embree names them.
struct TriangleNumbers {
  std::uint32_t triangle, geometry, instance;
};

// Triangle k into lanes i, i + 1, ... of a block. Returns whether any came nearer.
HWY_INLINE bool draw_lanes(const SetUpTriangles& t, int k, const TriangleNumbers& numbers,
                           DrawnBlock& block, int i) {
  RayPacket& packet = block.group->packet;
  const F3 direction = load(block.direction, i);
  const EdgeFunctions e = edge_functions(t, k, direction);
  const F half = exact_dot(lane_of(t.normal, k), direction);
  const F denominator = half + half;
  const F distance = exact_reciprocal(denominator) * set(t.depth[k]);
  const F far = load_floats(packet.far + i);
  const F infinity = set(std::numeric_limits<float>::infinity());
  const M passes =
      hn::And(hn::And(e.passes, hn::Ne(denominator, set(0.0F))),
              hn::And(hn::Ge(distance, load_floats(packet.near + i)), hn::Le(distance, infinity)));
  if ((t.firm >> k & 1) == 0) {
    block.unsure |= bits_of(passes, i);
    return false;
  }
  const F second = load(block.second, i);
  const F next = hn::Min(second, hn::Max(distance, far));
  hn::Store(hn::IfThenElse(passes, next, second), FloatTag(), block.second.lane + i);
  const M nearer = hn::And(passes, hn::Lt(distance, far));
  const shading::LaneMask now = bits_of(nearer, i);
  if (now == 0) return false;

  const F inverse =
      hn::IfThenElseZero(hn::Ge(hn::Abs(e.sum), set(1e-18F)), exact_reciprocal(e.sum));
  const F one = set(1.0F);
  put_some(distance, nearer, packet.far + i);
  put_some(hn::Min(e.u * inverse, one), nearer, packet.u + i);
  put_some(hn::Min(e.v * inverse, one), nearer, packet.v + i);
  put_numbers(numbers.triangle, nearer, packet.triangle + i);
  put_numbers(numbers.geometry, nearer, packet.geometry + i);
  put_numbers(numbers.instance, nearer, packet.instance + i);
  const M inside = hn::And(hn::Gt(hn::Abs(e.u), set(t.margin[0][k])),
                           hn::And(hn::Gt(hn::Abs(e.v), set(t.margin[1][k])),
                                   hn::Gt(hn::Abs(e.w), set(t.margin[2][k]))));
  const shading::LaneMask safe = bits_of(inside, i);
  block.edge = (block.edge & ~now) | (now & ~safe);
  return true;
}

// Leaves of the pairs those of which the triangle passes a ray.
HWY_INLINE void keep_passing(const SetUpTriangles& t, const DrawnSquare& square,
                             DrawnPairs& pairs) {
  int kept = 0;
  for (int p = 0; p < pairs.size; ++p) {
    const std::int32_t pair = pairs.pair[p];
    const DrawnBlock& block = square.blocks[block_of(pair)];
    shading::LaneMask passes = 0;
    for (int i = 0; i < kPacketRays; i += lanes())
      passes |= bits_of(edge_functions(t, triangle_of(pair), load(block.direction, i)).passes, i);
    pairs.pair[kept] = pair;
    kept += passes != 0 ? 1 : 0;
  }
  pairs.size = kept;
}

HWY_INLINE void find_beyond(DrawnSquare& square) {
  for (shading::LaneMask rest = square.unlimited; rest != 0; rest &= rest - 1) {
    const int b = std::countr_zero(rest);
    F most = set(0.0F);
    for (int i = 0; i < kPacketRays; i += lanes())
      most = hn::Max(most, load_floats(square.blocks[b].group->packet.far + i));
    square.beyond[b] = kTie * hn::GetLane(hn::MaxOfLanes(FloatTag(), most));
  }
  square.unlimited = 0;
}

HWY_INLINE const glm::uvec3& corners_of(const RaySpaces& scene, const BinnedTriangle& triangle) {
  return scene.instances[triangle.instance].mesh->triangles[triangle.triangle];
}

// The triangles of a batch into their blocks, those that pass a ray first: whether they do is as
// hard to foresee.
void draw_batch(const RaySpaces& scene, const DrawnBatch& batch, DrawnSquare& square) {
  const std::uint32_t instance = batch.triangle[0]->instance;
  const RaySpace& space = scene.of(instance);
  CornerLanes corners;
  for (int k = 0; k < batch.size; ++k) {
    const BinnedTriangle& triangle = *batch.triangle[k];
    set_corners(scene.instances[triangle.instance].positions, corners_of(scene, triangle), k,
                corners);
  }
  for (int k = batch.size; k < kPacketRays; ++k) clear_corners(k, corners);
  SetUpTriangles set_up;
  set_up_triangles(corners, space, set_up);
  DrawnPairs pairs;
  list_pairs(batch, pairs);
  keep_passing(set_up, square, pairs);
  for (int p = 0; p < pairs.size; ++p) {
    const int k = triangle_of(pairs.pair[p]), b = block_of(pairs.pair[p]);
    const BinnedTriangle& triangle = *batch.triangle[k];
    const TriangleNumbers numbers{triangle.triangle, space.is_world ? triangle.instance : 0,
                                  space.is_world ? kMiss : triangle.instance};
    bool nearer = false;
    for (int i = 0; i < kPacketRays; i += lanes())
      nearer = draw_lanes(set_up, k, numbers, square.blocks[b], i) || nearer;
    square.unlimited |= nearer ? 1U << b : 0U;
  }
}

// Directions as Embree brings them to a space.
void find_directions(const RaySpace& space, DrawnSquare& square) {
  const F3 x = set(space.to_local[0]), y = set(space.to_local[1]), z = set(space.to_local[2]);
  for (shading::LaneMask rest = square.drawn; rest != 0; rest &= rest - 1) {
    DrawnBlock& block = square.blocks[std::countr_zero(rest)];
    const RayPacket& packet = block.group->packet;
    for (int i = 0; i < kPacketRays; i += lanes()) {
      const F3 d{load_floats(packet.direction_x + i), load_floats(packet.direction_y + i),
                 load_floats(packet.direction_z + i)};
      const auto moved = [&](F a, F b, F c) {
        return hn::MulAdd(d.x, a, hn::MulAdd(d.y, b, d.z * c));
      };
      const F3 local{moved(x.x, y.x, z.x), moved(x.y, y.y, z.y), moved(x.z, y.z, z.z)};
      put_lanes(space.is_world ? d : local, block.direction, i);
    }
  }
}

// Blocks of the square that do not hide the triangle.
HWY_INLINE shading::LaneMask seen_blocks(const BinnedTriangle& triangle,
                                         const DrawnSquare& square) {
  shading::LaneMask hidden = 0;
  for (int i = 0; i < kSquareBlocks; i += lanes())
    hidden |= bits_of(hn::Gt(set(triangle.nearest), load(square.beyond, i)), i);
  return triangle.blocks & square.drawn & ~hidden;
}

// A triangle's corners are scattered in memory, and so are their positions: each is asked for some
// triangles ahead.
constexpr std::size_t kCornersAhead = 40, kPositionsAhead = 20;

HWY_INLINE void fetch_corners(const RaySpaces& scene, const BinnedTriangle& triangle) {
  __builtin_prefetch(&corners_of(scene, triangle));
}
HWY_INLINE void fetch_positions(const RaySpaces& scene, const BinnedTriangle& triangle) {
  const glm::uvec3& corners = corners_of(scene, triangle);
  const glm::vec3* positions = scene.instances[triangle.instance].positions;
  for (int c = 0; c < 3; ++c) __builtin_prefetch(positions + corners[c]);
}

void draw_triangles_of(const RaySpaces& scene, std::span<const BinnedTriangle> triangles,
                       DrawnSquare& square) {
  const std::uint32_t none = static_cast<std::uint32_t>(scene.spaces.size());
  std::uint32_t space = none;
  DrawnBatch batch;
  const auto draw = [&] {
    if (batch.size != 0) draw_batch(scene, batch, square);
    batch.size = 0;
    find_beyond(square);
  };
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    if (k + kCornersAhead < triangles.size()) fetch_corners(scene, triangles[k + kCornersAhead]);
    if (k + kPositionsAhead < triangles.size())
      fetch_positions(scene, triangles[k + kPositionsAhead]);
    const BinnedTriangle& triangle = triangles[k];
    const shading::LaneMask blocks = seen_blocks(triangle, square);
    if (blocks == 0) continue;
    const std::uint32_t its = scene.numbers[triangle.instance];
    if (its != space || batch.size == kPacketRays) draw();
    if (its != space) find_directions(scene.spaces[its], square);
    space = its;
    batch.triangle[batch.size] = &triangle;
    batch.blocks[batch.size++] = blocks;
  }
  if (batch.size != 0) draw_batch(scene, batch, square);
}

int keep_certain(DrawnBlock& block) {
  RayPacket& packet = block.group->packet;
  shading::LaneMask active = 0, certain = 0;
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const IntTag d;
    const I rays = hn::Load(d, block.group->active.ray + i);
    active |= bits_of(hn::RebindMask(FloatTag(), hn::Ne(rays, hn::Zero(d))), i);
    const F far = load_floats(packet.far + i), second = load(block.second, i);
    const M missed = hn::Eq(far, set(std::numeric_limits<float>::infinity()));
    const F u = load_floats(packet.u + i), v = load_floats(packet.v + i);
    const F least = hn::Min(hn::Min(u, v), set(1.0F) - (u + v));
    const M apart = hn::And(hn::Ge(second, far * set(kTie)), hn::Ge(least, set(kOnEdge)));
    certain |= bits_of(missed, i) | (bits_of(apart, i) & ~block.edge);
  }
  if ((active & (~certain | block.unsure)) == 0) return std::popcount(active);
  for (int i = 0; i < kPacketRays; ++i) {
    packet.far[i] = std::numeric_limits<float>::infinity();
    packet.triangle[i] = packet.geometry[i] = packet.instance[i] = kMiss;
  }
  return 0;
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {

HWY_EXPORT(draw_triangles_of);
HWY_EXPORT(keep_certain);

void DrawnSquare::clear() { drawn = unlimited = 0; }

void DrawnSquare::add(int block, RayGroup& group) {
  DrawnBlock& to = blocks[block];
  to.group = &group;
  to.unsure = to.edge = 0;
  beyond[block] = std::numeric_limits<float>::infinity();
  for (float& second : to.second.lane) second = beyond[block];
  drawn |= 1U << block;
}

void draw_triangles(const RaySpaces& scene, std::span<const BinnedTriangle> triangles,
                    DrawnSquare& square) {
  HWY_DYNAMIC_DISPATCH(draw_triangles_of)(scene, triangles, square);
}

int keep_certain_hits(DrawnBlock& block) { return HWY_DYNAMIC_DISPATCH(keep_certain)(block); }

}  // namespace delray::raytrace
#endif
