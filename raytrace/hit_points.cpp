#include "raytrace/internal/hit_points.h"

#include <bit>

#include "raytrace/internal/edges.h"
#include "raytrace/intersection.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/hit_points.cpp"
#include <hwy/foreach_target.h>
// What is compiled per target comes after it.
#include <hwy/highway.h>

#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

using namespace shading::HWY_NAMESPACE;

// Numbers of triangles' corners.
struct Corners {
  I a, b, c;
};

HWY_INLINE I times_three(I x) { return x + x + x; }

HWY_INLINE Corners corners_of(const scenes::Mesh& mesh, I triangle) {
  const auto* first = reinterpret_cast<const std::int32_t*>(mesh.triangles.data());
  const I at = times_three(triangle);
  const IntTag d;
  return {hn::GatherIndex(d, first, at), hn::GatherIndex(d, first, at + set(1)),
          hn::GatherIndex(d, first, at + set(2))};
}

HWY_INLINE F3 gathered(const glm::vec3* values, I vertex) {
  const FloatTag d;
  const I at = times_three(vertex);
  return {hn::GatherIndex(d, &values->x, at), hn::GatherIndex(d, &values->y, at),
          hn::GatherIndex(d, &values->z, at)};
}

struct Weights {
  F a, b, c;
};

HWY_INLINE F3 interpolated(const std::vector<glm::vec3>& values, const Corners& corners,
                           const Weights& w) {
  const glm::vec3* first = values.data();
  return gathered(first, corners.a) * w.a + gathered(first, corners.b) * w.b +
         gathered(first, corners.c) * w.c;
}

// Component k of values that have 2 or 4.
template <int kComponents>
HWY_INLINE F component(const float* values, I vertex, int k) {
  static_assert(kComponents == 2 || kComponents == 4);
  return hn::GatherIndex(FloatTag(), values + k, hn::ShiftLeft<kComponents / 2>(vertex));
}

template <int kComponents>
HWY_INLINE F interpolated(const float* values, const Corners& corners, const Weights& w, int k) {
  return component<kComponents>(values, corners.a, k) * w.a +
         component<kComponents>(values, corners.b, k) * w.b +
         component<kComponents>(values, corners.c, k) * w.c;
}

HWY_INLINE F3 transformed(const glm::mat3& m, const F3& v) {
  return set(m[0]) * v.x + set(m[1]) * v.y + set(m[2]) * v.z;
}
HWY_INLINE F3 transformed(const glm::mat4x3& m, const F3& v) {
  return set(m[0]) * v.x + set(m[1]) * v.y + set(m[2]) * v.z + set(m[3]);
}

HWY_INLINE F largest(const F3& v) {
  return max_of(max_of(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
}

HWY_INLINE F3 unit(const F3& v, const F3& otherwise) {
  const F squared = dot(v, v);
  return choose(hn::Gt(squared, set(0.0F)), v * (set(1.0F) / hn::Sqrt(squared)), otherwise);
}

// What only materials with textures look at.
HWY_INLINE void find_texture_point(const Placement& placement, const Corners& corners,
                                   const Weights& w, const F3& geometric_normal, F area, int i,
                                   M active, RayGroup& group) {
  const scenes::Mesh& mesh = *placement.mesh;
  shading::Points& points = group.points;
  const F zero = set(0.0F);
  F u = zero, v = zero, step = zero, handedness = zero;
  F3 tangent = set(glm::vec3(0.0F));
  if (!mesh.uvs.empty()) {
    const float* uvs = &mesh.uvs.data()->x;
    u = interpolated<2>(uvs, corners, w, 0);
    v = interpolated<2>(uvs, corners, w, 1);
    const F u_a = component<2>(uvs, corners.a, 0), v_a = component<2>(uvs, corners.a, 1);
    const F ab_u = component<2>(uvs, corners.b, 0) - u_a;
    const F ab_v = component<2>(uvs, corners.b, 1) - v_a;
    const F ac_u = component<2>(uvs, corners.c, 0) - u_a;
    const F ac_v = component<2>(uvs, corners.c, 1) - v_a;
    const F uv_area = hn::Abs(ab_u * ac_v - ab_v * ac_u);
    const F cosine = hn::Abs(dot(geometric_normal, load(group.view, i)));
    const FloatTag df;
    const F width =
        load(group.width, i) + hn::Load(df, group.packet.far + i) * load(group.spread, i);
    const F along = width * hn::Sqrt(uv_area / area) / max_of(cosine, set(kSteepest));
    step = hn::IfThenElseZero(hn::Gt(area, zero), along);
    if (!mesh.tangents.empty()) {
      const float* tangents = &mesh.tangents.data()->x;
      const F3 sum = {interpolated<4>(tangents, corners, w, 0),
                      interpolated<4>(tangents, corners, w, 1),
                      interpolated<4>(tangents, corners, w, 2)};
      const glm::mat3 linear(placement.to_world);
      tangent = unit(placement.identity ? sum : transformed(linear, sum), set(glm::vec3(1, 0, 0)));
      const M mirrored = hn::Lt(component<4>(tangents, corners.a, 3), zero);
      handedness =
          hn::IfThenElse(mirrored, set(-placement.orientation), set(placement.orientation));
    }
  }
  store(u, active, i, points.u);
  store(v, active, i, points.v);
  store(step, active, i, points.footprint_dx_u);
  store(zero, active, i, points.footprint_dx_v);
  store(zero, active, i, points.footprint_dy_u);
  store(step, active, i, points.footprint_dy_v);
  store(tangent, active, i, points.tangent);
  store(handedness, active, i, points.handedness);
}

HWY_INLINE void find_colours(const scenes::Mesh& mesh, const Corners& corners, const Weights& w,
                             int i, M active, shading::Points& points) {
  F3 colour = set(glm::vec3(1.0F));
  F alpha = set(1.0F);
  if (!mesh.colours.empty()) {
    const float* colours = &mesh.colours.data()->x;
    colour = {interpolated<4>(colours, corners, w, 0), interpolated<4>(colours, corners, w, 1),
              interpolated<4>(colours, corners, w, 2)};
    alpha = interpolated<4>(colours, corners, w, 3);
  }
  store(colour, active, i, points.colour);
  store(alpha, active, i, points.colour_alpha);
}

// The points of lanes that hit the same placement.
void find_placement_points(const Placement& placement, shading::LaneMask mask, RayGroup& group) {
  const scenes::Mesh& mesh = *placement.mesh;
  const RayPacket& packet = group.packet;
  shading::Points& points = group.points;
  const FloatTag d;
  const IntTag di;
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const M active = mask_of(mask, i);
    if (hn::AllFalse(d, active)) continue;
    // Lanes of other placements look at triangle 0.
    const I triangle = hn::IfThenElseZero(
        hn::RebindMask(di, active),
        hn::Load(di, reinterpret_cast<const std::int32_t*>(packet.triangle) + i));
    const F u = hn::Load(d, packet.u + i), v = hn::Load(d, packet.v + i);
    const Weights weights = {set(1.0F) - u - v, u, v};
    const Corners corners = corners_of(mesh, triangle);
    F3 a = gathered(placement.positions, corners.a);
    F3 b = gathered(placement.positions, corners.b);
    F3 c = gathered(placement.positions, corners.c);
    if (placement.instanced) {
      a = transformed(placement.to_world, a);
      b = transformed(placement.to_world, b);
      c = transformed(placement.to_world, c);
    }
    const F3 ab = b - a, ac = c - a;
    const F3 position = a + ab * u + ac * v;
    const F offset =
        set(kOffset) * (max_of(max_of(largest(a), largest(b)), largest(c)) +
                        max_of(largest(ab), largest(ac)) + set(placement.transform_scale));
    const F3 normal_of_corners = cross(ab, ac);
    const F area = hn::Sqrt(dot(normal_of_corners, normal_of_corners));
    const F3 geometric_normal =
        choose(hn::Gt(area, set(0.0F)), normal_of_corners * (set(placement.orientation) / area),
               set(glm::vec3(0, 0, 1)));
    F3 normal = geometric_normal;
    if (!mesh.normals.empty()) {
      normal = interpolated(mesh.normals, corners, weights);
      if (!placement.identity) normal = transformed(placement.normal_to_world, normal);
      normal = unit(normal, geometric_normal);
    }
    store(position, active, i, points.position);
    store(geometric_normal, active, i, points.geometric_normal);
    store(normal, active, i, points.normal);
    store(offset, active, i, group.offset);
    hn::Store(hn::IfThenElse(
                  hn::RebindMask(di, active), set(static_cast<std::int32_t>(placement.material)),
                  hn::Load(di, reinterpret_cast<const std::int32_t*>(group.material) + i)),
              di, reinterpret_cast<std::int32_t*>(group.material) + i);
    if (points.coloured) find_colours(mesh, corners, weights, i, active, points);
    if (placement.textured) {
      find_texture_point(placement, corners, weights, geometric_normal, area, i, active, group);
    }
  }
}

// Sets hits, and the number of the placement of each lane. Returns whether it is the same for all
// that hit.
bool find_hits(RayGroup& group, std::uint32_t* placements) {
  const IntTag d;
  const auto ints = [](std::uint32_t* p) { return reinterpret_cast<std::int32_t*>(p); };
  RayPacket& packet = group.packet;
  const I none = set(-1);
  shading::LaneMask hits = 0;
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const I instance = hn::Load(d, ints(packet.instance) + i);
    const I placement =
        hn::IfThenElse(hn::Eq(instance, none), hn::Load(d, ints(packet.geometry) + i), instance);
    hn::Store(placement, d, ints(placements) + i);
    const auto hit = hn::And(hn::Ne(hn::Load(d, ints(packet.triangle) + i), none),
                             hn::Ne(hn::Load(d, group.active.ray + i), set(0)));
    hits |= bits_of(hn::RebindMask(FloatTag(), hit), i);
  }
  group.hits = hits;
  if (hits == 0) return true;
  const I first =
      set(static_cast<std::int32_t>(placements[hwy::Num0BitsBelowLS1Bit_Nonzero32(hits)]));
  shading::LaneMask same = 0;
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const auto equal = hn::Eq(hn::Load(d, ints(placements) + i), first);
    same |= bits_of(hn::RebindMask(FloatTag(), equal), i);
  }
  return (hits & ~same) == 0;
}

bool find_edge_lanes(const ActiveRays& active, const RayPacket& packet, ActiveRays& edges) {
  const FloatTag d;
  const IntTag di;
  bool any = false;
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const F u = hn::Load(d, packet.u + i), v = hn::Load(d, packet.v + i);
    const F least = hn::Min(hn::Min(u, v), set(1.0F) - (u + v));
    const auto* triangle = reinterpret_cast<const std::int32_t*>(packet.triangle) + i;
    const auto hit = hn::And(hn::Ne(hn::Load(di, triangle), set(-1)),
                             hn::RebindMask(di, hn::Lt(least, set(kNearEdge))));
    const I edge = hn::IfThenElseZero(hit, hn::Load(di, active.ray + i));
    hn::Store(edge, di, edges.ray + i);
    any = any || !hn::AllTrue(di, hn::Eq(edge, set(0)));
  }
  return any;
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raytrace {
namespace {

HWY_EXPORT(find_placement_points);
HWY_EXPORT(find_hits);
HWY_EXPORT(find_edge_lanes);

// From so many lanes on vectors are faster than lane by lane.
constexpr int kFewestLanes = 3;

// Corners of more vertices, times three, would not fit 32 bits.
constexpr std::size_t kMostVertices = 1U << 29;

void find_point(const Placement& placement, int i, RayGroup& group) {
  const glm::vec3 direction = -group.view.get(i);
  const float width = group.width[i] + group.packet.far[i] * group.spread[i];
  const Intersection at = intersection(placement, hit_of(group.packet, i), direction, {width});
  set_point(group.points, i, at.point);
  group.offset[i] = at.offset;
  group.material[i] = placement.material;
}

// Calls f(placement, triangle) for the hits.
template <class F>
void for_hits(std::span<const Placement> placements, const RayGroup& group, F&& f) {
  const RayPacket& packet = group.packet;
  for (int i = 0; i < kPacketRays; ++i) {
    if (group.active.ray[i] == 0 || packet.triangle[i] == kMiss) continue;
    const Hit hit = hit_of(packet, i);
    f(placements[hit.placement], hit.triangle);
  }
}

}  // namespace

bool find_edges(const ActiveRays& active, const RayPacket& packet, ActiveRays& edges) {
  return HWY_DYNAMIC_DISPATCH(find_edge_lanes)(active, packet, edges);
}

void fetch_corners(std::span<const Placement> placements, const RayGroup& group) {
  for_hits(placements, group, [](const Placement& placement, std::uint32_t triangle) {
    __builtin_prefetch(&placement.mesh->triangles[triangle]);
  });
}

void fetch_vertices(std::span<const Placement> placements, const RayGroup& group) {
  for_hits(placements, group, [](const Placement& placement, std::uint32_t triangle) {
    const scenes::Mesh& mesh = *placement.mesh;
    const glm::uvec3 corners = mesh.triangles[triangle];
    for (int k = 0; k < 3; ++k) {
      __builtin_prefetch(placement.positions + corners[k]);
      if (!mesh.normals.empty()) __builtin_prefetch(&mesh.normals[corners[k]]);
      if (!mesh.colours.empty()) __builtin_prefetch(&mesh.colours[corners[k]]);
      if (placement.textured && !mesh.uvs.empty()) __builtin_prefetch(&mesh.uvs[corners[k]]);
    }
  });
}

void find_points(std::span<const Placement> placements, RayGroup& group) {
  alignas(64) std::uint32_t placement[kPacketRays];
  const bool one = HWY_DYNAMIC_DISPATCH(find_hits)(group, placement);
  shading::LaneMask hits = group.hits;
  group.points.coloured = false;
  for (shading::LaneMask rest = hits; rest != 0; rest = one ? 0 : rest & (rest - 1)) {
    const scenes::Mesh& mesh = *placements[placement[std::countr_zero(rest)]].mesh;
    group.points.coloured = group.points.coloured || !mesh.colours.empty();
  }
  while (hits != 0) {
    const std::uint32_t number = placement[std::countr_zero(hits)];
    shading::LaneMask same = one ? hits : 0;
    for (int i = 0; !one && i < kPacketRays; ++i) same |= placement[i] == number ? 1U << i : 0U;
    same &= hits;
    hits &= ~same;
    const Placement& where = placements[number];
    if (std::popcount(same) >= kFewestLanes && where.mesh->positions.size() <= kMostVertices &&
        where.mesh->triangles.size() <= kMostVertices) {
      HWY_DYNAMIC_DISPATCH(find_placement_points)(where, same, group);
      continue;
    }
    for (; same != 0; same &= same - 1) find_point(where, std::countr_zero(same), group);
  }
}

}  // namespace delray::raytrace
#endif
