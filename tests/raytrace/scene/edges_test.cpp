// Rays that hit two triangles of an edge at the same distance, by rounding, find the same one in
// whatever scenes the triangles are.
#include "raytrace/scene/edges.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>
#include <vector>

#include "raytrace/tracer.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

constexpr int kRows = 250;
constexpr float kRow = 0.03F;  // of a width of 1

// A strip of slivers, folded at every second long edge, and rough.
scenes::Mesh folded_slivers(std::mt19937& random) {
  scenes::Mesh mesh;
  for (int row = 0; row <= kRows; ++row) {
    for (int side = 0; side < 2; ++side) {
      const float rough = static_cast<float>(random() % 1000) * 5e-6F;
      const float height = rough + (row % 2 == 0 ? 0.0F : 5 * kRow);
      mesh.positions.emplace_back(side, static_cast<float>(row) * kRow, height);
    }
  }
  for (std::uint32_t i = 0; i + 2 < mesh.positions.size(); i += 2) {
    mesh.triangles.emplace_back(i, i + 1, i + 3);
    mesh.triangles.emplace_back(i, i + 3, i + 2);
  }
  return mesh;
}

// Every second triangle from `first` on.
scenes::Mesh half_of(const scenes::Mesh& mesh, std::uint32_t first) {
  scenes::Mesh half;
  half.positions = mesh.positions;
  for (std::size_t i = first; i < mesh.triangles.size(); i += 2)
    half.triangles.push_back(mesh.triangles[i]);
  return half;
}

scenes::Scene scene_of(const scenes::Mesh& mesh, bool instanced) {
  scenes::Scene scene;
  add(scene, mesh);
  if (instanced) {
    scene.instances[0].transform = placed(1.25F, {3, -2, 1});
    scene.instances.push_back({0, placed(1, {0, 0, -1000})});
  }
  return scene;
}

RayPacket packet_of(const glm::vec3& eye, const glm::vec3& direction, float far) {
  RayPacket packet{};
  for (int i = 0; i < kPacketRays; ++i) {
    packet.origin_x[i] = eye.x, packet.origin_y[i] = eye.y, packet.origin_z[i] = eye.z;
    packet.direction_x[i] = direction.x, packet.direction_y[i] = direction.y;
    packet.direction_z[i] = direction.z;
    packet.far[i] = far;
    packet.mask[i] = 0xFFFFFFFFU;
    packet.triangle[i] = packet.geometry[i] = packet.instance[i] = kMiss;
  }
  return packet;
}

TEST(Edges, OfFoldsAreTheSameWhateverElseIsInTheScene) {
  const unsigned seed = 20261127;
  std::mt19937 random(seed);
  const scenes::Mesh mesh = folded_slivers(random);
  ActiveRays one_ray;
  for (int i = 0; i < kPacketRays; ++i) one_ray.ray[i] = i == 0 ? -1 : 0;
#if defined(__x86_64__)
  const std::vector<std::string> instruction_sets = {"", "sse2"};
#else
  const std::vector<std::string> instruction_sets = {""};
#endif
  for (const std::string& isa : instruction_sets) {
    for (const bool instanced : {false, true}) {
      BuildOptions options;
      options.isa = isa;
      const scenes::Scene scene = scene_of(mesh, instanced);
      const scenes::Scene parts[2] = {scene_of(half_of(mesh, 0), instanced),
                                      scene_of(half_of(mesh, 1), instanced)};
      const Tracer whole = make_tracer(scene, options);
      const Tracer halves[2] = {make_tracer(parts[0], options), make_tracer(parts[1], options)};
      const glm::mat4x3& to_world = whole.instances[0].to_world;
      const glm::vec3 eye = to_world * glm::vec4(0.3F, -200, 100, 1);
      int hits = 0;
      for (int k = 0; k < 30000; ++k) {
        const auto unit = [&] { return static_cast<float>(random() % 1000000) * 1e-6F; };
        const float x = unit(), y = unit() * kRow * kRows;
        const glm::vec3 direction = to_world * glm::vec4(x, y, 0, 1) - eye;
        const bool coherent = k % 2 == 0;
        RayPacket packet = packet_of(eye, direction, std::numeric_limits<float>::infinity());
        whole.embree.intersect(one_ray, packet, coherent);
        Hit least;
        for (std::uint32_t half = 0; half < 2; ++half) {
          RayPacket some =
              packet_of(eye, direction,
                        least.triangle == kMiss ? std::numeric_limits<float>::infinity()
                                                : a_little_further(least.distance));
          halves[half].embree.intersect(one_ray, some, coherent);
          if (some.triangle[0] == kMiss) continue;
          Hit hit = hit_of(some, 0);
          hit.triangle = 2 * hit.triangle + half;
          if (least.triangle == kMiss || is_nearer(hit, least)) least = hit;
        }
        ASSERT_EQ(packet.triangle[0], least.triangle)
            << isa << instanced << ' ' << k << ' ' << seed;
        if (least.triangle == kMiss) continue;
        ++hits;
        ASSERT_EQ(packet.far[0], least.distance) << isa << instanced << ' ' << k << ' ' << seed;
      }
      EXPECT_GT(hits, 29000);
    }
  }
}

}  // namespace
}  // namespace delray::raytrace
