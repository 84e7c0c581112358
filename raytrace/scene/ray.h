// Rays and what they hit, in the layout that Embree reads and writes.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <tuple>

namespace delray::raytrace {

inline constexpr std::uint32_t kMiss = 0xFFFFFFFFU;

// One ray: points origin + t * direction, near <= t <= far; the direction need not have unit
// length. Intersecting it sets far to the distance of the nearest hit, in units of the direction,
// and fills in the hit; triangle stays kMiss where there is none.
struct alignas(16) Ray {
  float origin_x, origin_y, origin_z, near;
  float direction_x, direction_y, direction_z, time = 0.0F;
  float far = std::numeric_limits<float>::infinity();
  std::uint32_t mask = 0xFFFFFFFFU, id = 0, flags = 0;

  // The hit. Barycentric: the point is (1 - u - v) * vertex 0 + u * vertex 1 + v * vertex 2.
  float normal_x, normal_y, normal_z;  // as Embree has it: not normalised, in space of the mesh
  float u, v;
  std::uint32_t triangle = kMiss;
  std::uint32_t geometry = kMiss;       // of the geometry instance, unless `instance` is set
  std::uint32_t instance = kMiss;       // of the geometry instance, if Embree instances it
  std::uint32_t instance_part = kMiss;  // not used: Embree from 4.3 on may write there
};

inline constexpr int kPacketRays = 16;
inline constexpr int kBlockSide = 4;  // 4 x 4 pixels are a block: lane i is (x + i % 4, y + i / 4)

// Sixteen rays of a block of 4 x 4 pixels; element i is ray i.
struct alignas(64) RayPacket {
  float origin_x[kPacketRays], origin_y[kPacketRays], origin_z[kPacketRays], near[kPacketRays];
  float direction_x[kPacketRays], direction_y[kPacketRays], direction_z[kPacketRays],
      time[kPacketRays];
  float far[kPacketRays];
  std::uint32_t mask[kPacketRays], id[kPacketRays], flags[kPacketRays];
  float normal_x[kPacketRays], normal_y[kPacketRays], normal_z[kPacketRays];
  float u[kPacketRays], v[kPacketRays];
  std::uint32_t triangle[kPacketRays], geometry[kPacketRays], instance[kPacketRays];
  std::uint32_t instance_part[kPacketRays];  // not used
};

// The part of a packet that shadow rays need.
struct alignas(64) ShadowPacket {
  float origin_x[kPacketRays], origin_y[kPacketRays], origin_z[kPacketRays], near[kPacketRays];
  float direction_x[kPacketRays], direction_y[kPacketRays], direction_z[kPacketRays],
      time[kPacketRays];
  float far[kPacketRays];
  std::uint32_t mask[kPacketRays], id[kPacketRays], flags[kPacketRays];
};

// Which rays of a packet take part: -1 yes, 0 no.
struct alignas(64) ActiveRays {
  std::int32_t ray[kPacketRays];
};

// Where a ray met a triangle.
struct Hit {
  float distance = 0.0F;  // in units of the ray's direction
  std::uint32_t instance = kMiss, triangle = kMiss;
  float u = 0.0F, v = 0.0F;
};

// What an instance of a part of a scene is in the whole scene: its number, and of triangle i of its
// mesh triangles[i].
struct GeometryNumbers {
  std::uint32_t instance = kMiss;
  const std::uint32_t* triangles = nullptr;
};

// The hit as it is in the whole scene. `numbers` empty: it is the whole one.
inline Hit in_whole_scene(Hit hit, std::span<const GeometryNumbers> numbers) {
  if (numbers.empty()) return hit;
  const GeometryNumbers& of = numbers[hit.instance];
  hit.instance = of.instance;
  hit.triangle = of.triangles[hit.triangle];
  return hit;
}

// The order of hits: of equally near ones the lowest instance, then triangle, comes first.
inline bool is_nearer(const Hit& a, const Hit& b) {
  return std::tie(a.distance, a.instance, a.triangle) <
         std::tie(b.distance, b.instance, b.triangle);
}

// The hit of a ray that hit something. REQUIRES: ray.triangle != kMiss.
inline Hit hit_of(const Ray& ray) {
  return {ray.far, ray.instance != kMiss ? ray.instance : ray.geometry, ray.triangle, ray.u, ray.v};
}
inline Hit hit_of(const RayPacket& packet, int i) {
  return {packet.far[i], packet.instance[i] != kMiss ? packet.instance[i] : packet.geometry[i],
          packet.triangle[i], packet.u[i], packet.v[i]};
}

// Surfaces on the way of a shadow ray that do not stop it altogether, in no particular order.
struct SeeThrough {
  static constexpr int kMost = 12;  // beyond that many layers nothing is seen
  SeeThrough() {}                   // thousands a second: hits are left as they are
  int count = 0;
  union {
    Hit hits[kMost];
  };
};

}  // namespace delray::raytrace
