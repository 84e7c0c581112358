// Gathers corners of the hit triangles lane by lane, instance by instance, and computes their
// points by vectors, as intersection.cpp does for one.
//
// Degenerate: triangles whose area under- or overflows are measured with their longest edge for a
// unit; those without area get a fixed normal; lanes without a hit are left alone.
#include "raytrace/scene/hit_points.h"

#include <bit>

#include "raytrace/scene/edges.h"
#include "raytrace/scene/intersection.h"
#include "raytrace/scene/splat_hits.h"

#ifndef DELRAY_RAYTRACE_GATHERED
#define DELRAY_RAYTRACE_GATHERED

namespace delray::raytrace {

// Texture coordinates of a set: [corner][lane].
struct CornerUvs {
  alignas(64) float u[3][kPacketRays], v[3][kPacketRays];
};

// What meshes and instances know of the triangles that lanes hit: [corner][axis][lane]. What a
// lane's mask does not ask for may hold anything.
struct Gathered {
  alignas(64) float position[3][3][kPacketRays], normal[3][3][kPacketRays];
  alignas(64) float linear[3][3][kPacketRays],
      origin[3][kPacketRays];  // GeometryInstance::to_world
  alignas(64) float normal_matrix[3][3][kPacketRays];
  alignas(64) float orientation[kPacketRays], transform_scale[kPacketRays];
  CornerUvs uvs[2];
  alignas(64) float tangent[3][3][kPacketRays], handedness[kPacketRays];
  alignas(64) float colour[3][3][kPacketRays], alpha[3][kPacketRays];
  shading::LaneMask instanced = 0;  // positions are to be moved
  shading::LaneMask placed = 0;     // normals and tangents are to be turned
  shading::LaneMask smooth = 0, tangents = 0, coloured = 0;
  shading::LaneMask textured[2] = {}, mapped[2] = {};  // by set: it is asked for; the mesh has it
};

}  // namespace delray::raytrace

#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/scene/hit_points.cpp"
#include <hwy/foreach_target.h>
// Code that is compiled per target comes after it.
#include <hwy/highway.h>

#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

using namespace shading::HWY_NAMESPACE;

// Three corners' vectors, or columns of a matrix.
HWY_INLINE F3 at(const float (&v)[3][kPacketRays], int i) {
  const FloatTag d;
  return {hn::Load(d, v[0] + i), hn::Load(d, v[1] + i), hn::Load(d, v[2] + i)};
}
HWY_INLINE F at(const float (&v)[kPacketRays], int i) { return hn::Load(FloatTag(), v + i); }

struct Weights {
  F a, b, c;
};

HWY_INLINE F3 interpolated(const float (&corners)[3][3][kPacketRays], const Weights& w, int i) {
  return at(corners[0], i) * w.a + at(corners[1], i) * w.b + at(corners[2], i) * w.c;
}
HWY_INLINE F interpolated(const float (&corners)[3][kPacketRays], const Weights& w, int i) {
  return at(corners[0], i) * w.a + at(corners[1], i) * w.b + at(corners[2], i) * w.c;
}

// Transforms of the lanes.
HWY_INLINE F3 turned(const float (&m)[3][3][kPacketRays], const F3& v, int i) {
  return at(m[0], i) * v.x + at(m[1], i) * v.y + at(m[2], i) * v.z;
}
HWY_INLINE F3 moved(const Gathered& g, const F3& v, int i) {
  return turned(g.linear, v, i) + at(g.origin, i);
}

HWY_INLINE F largest(const F3& v) {
  return max_of(max_of(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
}

HWY_INLINE F3 unit(const F3& v, const F3& otherwise) {
  const F squared = dot(v, v);
  return choose(hn::Gt(squared, set(0.0F)), v * (set(1.0F) / hn::Sqrt(squared)), otherwise);
}

// Computes the texture points that only materials with textures of the set look at.
HWY_INLINE void find_texture_points(const Gathered& g, int number, const Weights& w,
                                    const F3& geometric_normal, F area, int i, RayGroup& group) {
  const FloatTag d;
  const F zero = set(0.0F);
  const CornerUvs& uvs = g.uvs[number];
  const M active = mask_of(g.textured[number], i), mapped = mask_of(g.mapped[number], i);
  const F u_a = at(uvs.u[0], i), v_a = at(uvs.v[0], i);
  const F ab_u = at(uvs.u[1], i) - u_a, ab_v = at(uvs.v[1], i) - v_a;
  const F ac_u = at(uvs.u[2], i) - u_a, ac_v = at(uvs.v[2], i) - v_a;
  const F uv_area = hn::Abs(ab_u * ac_v - ab_v * ac_u);
  const F cosine = hn::Abs(dot(geometric_normal, load(group.view, i)));
  const F width = load(group.width, i) + hn::Load(d, group.packet.far + i) * load(group.spread, i);
  const F along = width * hn::Sqrt(uv_area / area) / max_of(cosine, set(kSteepest));
  const F step = hn::IfThenElseZero(hn::And(mapped, hn::Gt(area, zero)), along);
  shading::TexturePoints& to = group.points.uvs[number];
  store(hn::IfThenElseZero(mapped, interpolated(uvs.u, w, i)), active, i, to.u);
  store(hn::IfThenElseZero(mapped, interpolated(uvs.v, w, i)), active, i, to.v);
  store(step, active, i, to.dx_u);
  store(zero, active, i, to.dx_v);
  store(zero, active, i, to.dy_u);
  store(step, active, i, to.dy_v);
}

HWY_INLINE void find_tangents(const Gathered& g, const Weights& w, int i, shading::Points& points) {
  const F zero = set(0.0F);
  const M active = mask_of(g.textured[0], i);
  F3 tangent = set(glm::vec3(0.0F));
  F handedness = zero;
  if (g.tangents != 0) {
    const M has = mask_of(g.tangents, i);
    const F3 sum = interpolated(g.tangent, w, i);
    const F3 along_u = choose(mask_of(g.placed, i), turned(g.linear, sum, i), sum);
    const F orientation = at(g.orientation, i);
    tangent = where(has, unit(along_u, set(glm::vec3(1, 0, 0))));
    handedness = hn::IfThenElseZero(
        has, hn::IfThenElse(hn::Lt(at(g.handedness, i), zero), hn::Neg(orientation), orientation));
  }
  store(tangent, active, i, points.tangent);
  store(handedness, active, i, points.handedness);
}

// The points of lanes that were gathered.
void find_gathered_points(const Gathered& g, RayGroup& group) {
  const RayPacket& packet = group.packet;
  shading::Points& points = group.points;
  const FloatTag d;
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const M active = mask_of(group.hits, i);
    if (hn::AllFalse(d, active)) continue;
    const F u = hn::Load(d, packet.u + i), v = hn::Load(d, packet.v + i);
    const Weights weights = {set(1.0F) - u - v, u, v};
    F3 a = at(g.position[0], i), b = at(g.position[1], i), c = at(g.position[2], i);
    if (g.instanced != 0) {
      const M m = mask_of(g.instanced, i);
      a = choose(m, moved(g, a, i), a);
      b = choose(m, moved(g, b, i), b);
      c = choose(m, moved(g, c, i), c);
    }
    const F3 ab = b - a, ac = c - a;
    const F offset = set(kOffset) * (max_of(max_of(largest(a), largest(b)), largest(c)) +
                                     max_of(largest(ab), largest(ac)) + at(g.transform_scale, i));
    F3 normal_of_corners = cross(ab, ac);
    const F squared = dot(normal_of_corners, normal_of_corners);
    F area = hn::Sqrt(squared), length = area;
    const M fits = hn::And(hn::Ge(squared, set(kLeastSquare)), hn::Le(squared, set(kMostSquare)));
    if (!hn::AllTrue(d, hn::Or(fits, hn::Not(active)))) {
      const F size = max_of(largest(ab), largest(ac)), per = set(1.0F) / size;
      const F3 scaled = cross(ab * per, ac * per);
      const F scaled_length = hn::Sqrt(dot(scaled, scaled));
      normal_of_corners = choose(fits, normal_of_corners, scaled);
      length = hn::IfThenElse(fits, length, scaled_length);
      area = hn::IfThenElse(fits, area, scaled_length * size * size);
    }
    const F3 geometric_normal =
        choose(hn::Gt(length, set(0.0F)), normal_of_corners * (at(g.orientation, i) / length),
               set(glm::vec3(0, 0, 1)));
    F3 normal = geometric_normal;
    if (g.smooth != 0) {
      F3 sum = interpolated(g.normal, weights, i);
      if (g.placed != 0) {
        sum = choose(mask_of(g.placed, i), turned(g.normal_matrix, sum, i), sum);
      }
      normal = choose(mask_of(g.smooth, i), unit(sum, geometric_normal), geometric_normal);
    }
    store(a + ab * u + ac * v, active, i, points.position);
    store(geometric_normal, active, i, points.geometric_normal);
    store(normal, active, i, points.normal);
    store(offset, active, i, group.offset);
    if (g.textured[0] != 0) {
      find_texture_points(g, 0, weights, geometric_normal, area, i, group);
      find_tangents(g, weights, i, points);
    }
    if (g.textured[1] != 0) find_texture_points(g, 1, weights, geometric_normal, area, i, group);
    if (!points.coloured) continue;
    const M coloured = mask_of(g.coloured, i);
    const F3 white = set(glm::vec3(1.0F));
    store(choose(coloured, interpolated(g.colour, weights, i), white), active, i, points.colour);
    store(hn::IfThenElse(coloured, interpolated(g.alpha, weights, i), set(1.0F)), active, i,
          points.colour_alpha);
  }
}

// Sets hits, and the number of the instance of each lane.
void find_hits(RayGroup& group, std::uint32_t* instances) {
  const IntTag d;
  const auto ints = [](std::uint32_t* p) { return reinterpret_cast<std::int32_t*>(p); };
  RayPacket& packet = group.packet;
  const I none = set(-1);
  shading::LaneMask hits = 0;
  for (int i = 0; i < kPacketRays; i += lanes()) {
    const I nested = hn::Load(d, ints(packet.instance) + i);
    const I instance =
        hn::IfThenElse(hn::Eq(nested, none), hn::Load(d, ints(packet.geometry) + i), nested);
    hn::Store(instance, d, ints(instances) + i);
    const auto hit = hn::And(hn::Ne(hn::Load(d, ints(packet.triangle) + i), none),
                             hn::Ne(hn::Load(d, group.active.ray + i), set(0)));
    hits |= bits_of(hn::RebindMask(FloatTag(), hit), i);
  }
  group.hits = hits;
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

HWY_EXPORT(find_gathered_points);
HWY_EXPORT(find_hits);
HWY_EXPORT(find_edge_lanes);

void put(const glm::vec3& v, int lane, float (&to)[3][kPacketRays]) {
  to[0][lane] = v.x;
  to[1][lane] = v.y;
  to[2][lane] = v.z;
}

template <class F>
void for_lanes(shading::LaneMask lanes, F&& f) {
  for (; lanes != 0; lanes &= lanes - 1) f(std::countr_zero(lanes));
}

// Loads the texture coordinates of lanes that hit the same mesh; element i of corners belongs to
// lane i.
void gather_uvs(const scenes::Mesh& mesh, int set, const glm::uvec3* corners,
                shading::LaneMask lanes, Gathered& to) {
  to.textured[set] |= lanes;
  if (mesh.uvs_of(set).empty()) return;
  to.mapped[set] |= lanes;
  for_lanes(lanes, [&, uvs = mesh.uvs_of(set).data()](int i) {
    for (int k = 0; k < 3; ++k) {
      to.uvs[set].u[k][i] = uvs[corners[i][k]].x;
      to.uvs[set].v[k][i] = uvs[corners[i][k]].y;
    }
  });
}

void gather_tangents(const scenes::Mesh& mesh, const glm::uvec3* corners, shading::LaneMask lanes,
                     Gathered& to) {
  if (mesh.uvs.empty() || mesh.tangents.empty()) return;
  to.tangents |= lanes;
  for_lanes(lanes, [&, tangents = mesh.tangents.data()](int i) {
    for (int k = 0; k < 3; ++k) put(glm::vec3(tangents[corners[i][k]]), i, to.tangent[k]);
    to.handedness[i] = tangents[corners[i].x].w;
  });
}

void gather_transforms(const GeometryInstance& instance, shading::LaneMask lanes, Gathered& to) {
  to.placed |= lanes;
  if (instance.instanced) to.instanced |= lanes;
  for_lanes(lanes, [&](int i) {
    for (int k = 0; k < 3; ++k) {
      put(instance.to_world[k], i, to.linear[k]);
      put(instance.normal_to_world[k], i, to.normal_matrix[k]);
    }
    put(instance.to_world[3], i, to.origin);
  });
}

// Loads what the lanes' triangles of one instance need.
void gather(const GeometryInstance& instance, const std::uint32_t* triangles,
            shading::LaneMask lanes, Gathered& to) {
  const scenes::Mesh& mesh = *instance.mesh;
  glm::uvec3 corners[kPacketRays];
  for_lanes(lanes, [&, numbers = mesh.triangles.data(), positions = instance.positions](int i) {
    corners[i] = numbers[triangles[i]];
    for (int k = 0; k < 3; ++k) put(positions[corners[i][k]], i, to.position[k]);
    to.orientation[i] = instance.orientation;
    to.transform_scale[i] = instance.transform_scale;
  });
  if (!mesh.normals.empty()) {
    to.smooth |= lanes;
    for_lanes(lanes, [&, normals = mesh.normals.data()](int i) {
      for (int k = 0; k < 3; ++k) put(normals[corners[i][k]], i, to.normal[k]);
    });
  }
  if (instance.instanced || !instance.identity) gather_transforms(instance, lanes, to);
  if (!mesh.colours.empty()) {
    to.coloured |= lanes;
    for_lanes(lanes, [&, colours = mesh.colours.data()](int i) {
      for (int k = 0; k < 3; ++k) {
        put(glm::vec3(colours[corners[i][k]]), i, to.colour[k]);
        to.alpha[k][i] = colours[corners[i][k]].w;
      }
    });
  }
  for (int set = 0; set < instance.texture_sets; ++set) gather_uvs(mesh, set, corners, lanes, to);
  if (instance.texture_sets > 0) gather_tangents(mesh, corners, lanes, to);
}

// GCC 12 takes functions that do nothing but prefetch for functions that do nothing, and leaves out
// the calls; it knows nothing of what an asm statement does.
void fetch(const void* p) {
  __builtin_prefetch(p);
  asm volatile("");
}

// Calls f(instance, triangle) for the hits.
template <class F>
void for_hits(std::span<const GeometryInstance> instances, const RayGroup& group, F&& f) {
  const RayPacket& packet = group.packet;
  for (int i = 0; i < kPacketRays; ++i) {
    if (group.active.ray[i] == 0 || packet.triangle[i] == kMiss) continue;
    const Hit hit = hit_of(packet, i);
    f(instances[hit.instance], hit.triangle);
  }
}

// Points of splats, one by one.
void find_splat_points(std::span<const GeometryInstance> instances, const std::uint32_t* numbers,
                       shading::LaneMask lanes, RayGroup& group) {
  for_lanes(lanes, [&](int i) {
    const Hit hit = hit_of(group.packet, i);
    const Intersection at = splat_intersection(instances[numbers[i]], hit, -group.view.get(i));
    set_point(group.points, i, at.point);
    group.offset[i] = at.offset;
  });
}

}  // namespace

bool find_edges(const ActiveRays& active, const RayPacket& packet, ActiveRays& edges) {
  return HWY_DYNAMIC_DISPATCH(find_edge_lanes)(active, packet, edges);
}

void fetch_corners(std::span<const GeometryInstance> instances, const RayGroup& group) {
  for_hits(instances, group, [](const GeometryInstance& instance, std::uint32_t triangle) {
    fetch(&instance.mesh->triangles[triangle]);
  });
}

void fetch_vertices(std::span<const GeometryInstance> instances, const RayGroup& group) {
  for_hits(instances, group, [](const GeometryInstance& instance, std::uint32_t triangle) {
    const scenes::Mesh& mesh = *instance.mesh;
    const glm::uvec3 corners = mesh.triangles[triangle];
    for (int k = 0; k < 3; ++k) {
      fetch(instance.positions + corners[k]);
      if (!mesh.normals.empty()) fetch(&mesh.normals[corners[k]]);
      if (!mesh.colours.empty()) fetch(&mesh.colours[corners[k]]);
      for (int set = 0; set < instance.texture_sets; ++set) {
        if (!mesh.uvs_of(set).empty()) fetch(&mesh.uvs_of(set)[corners[k]]);
      }
    }
  });
}

void find_points(std::span<const GeometryInstance> instances, RayGroup& group) {
  alignas(64) std::uint32_t numbers[kPacketRays];
  HWY_DYNAMIC_DISPATCH(find_hits)(group, numbers);
  if (group.hits == 0) return;
  Gathered gathered;
  shading::LaneMask splats = 0;
  for (shading::LaneMask rest = group.hits; rest != 0;) {
    const std::uint32_t number = numbers[std::countr_zero(rest)];
    const GeometryInstance& instance = instances[number];
    shading::LaneMask same = 0;
    for (int i = 0; i < kPacketRays; ++i) same |= numbers[i] == number ? 1U << i : 0U;
    same &= rest;
    rest &= ~same;
    for_lanes(same, [&](int i) { group.material[i] = instance.material; });
    if (!instance.mesh->has_triangles()) {
      splats |= same;
      if (!instance.mesh->colours.empty()) gathered.coloured |= same;
      continue;
    }
    gather(instance, group.packet.triangle, same, gathered);
  }
  group.points.coloured = gathered.coloured != 0;
  if (splats != group.hits) HWY_DYNAMIC_DISPATCH(find_gathered_points)(gathered, group);
  if (splats != 0) find_splat_points(instances, numbers, splats, group);
}

}  // namespace delray::raytrace
#endif
