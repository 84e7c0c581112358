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

float unit_of(std::mt19937& random) { return static_cast<float>(random() % 1000000) * 1e-6F; }

// Ridges of two sheets, which lie so close to each other that near the ridge distances to both are
// the same by rounding.
constexpr float kSheet = 0.3F;
scenes::Mesh sharp_ridges(std::mt19937& random) {
  scenes::Mesh mesh;
  for (std::uint32_t row = 0; row < kRows; ++row) {
    const float y = static_cast<float>(row) * kSheet, away = 0.003F * kSheet;
    for (const float x : {0.0F, 1.0F}) mesh.positions.emplace_back(x, y, 0);
    for (const float side : {-away, away})
      mesh.positions.emplace_back(unit_of(random), y + side, -kSheet);
    const std::uint32_t ridge = 4 * row, first = random() % 2;
    mesh.triangles.emplace_back(ridge, ridge + 1, ridge + 2 + first);
    mesh.triangles.emplace_back(ridge, ridge + 1, ridge + 3 - first);
  }
  return mesh;
}

// Rays through `target` find the same triangle in the mesh and in its halves together, but for
// those that miss, of which there are few.
template <class Target>
void expect_same_in_halves(const scenes::Mesh& mesh, const glm::vec3& from, Target&& target) {
  constexpr int kRays = 30000;
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
      const glm::vec3 eye = to_world * glm::vec4(from, 1);
      int hits = 0;
      for (int k = 0; k < kRays; ++k) {
        const glm::vec3 direction = to_world * glm::vec4(target(), 1) - eye;
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
        ASSERT_EQ(packet.triangle[0], least.triangle) << isa << instanced << ' ' << k;
        if (least.triangle == kMiss) continue;
        ++hits;
        ASSERT_EQ(packet.far[0], least.distance) << isa << instanced << ' ' << k;
      }
      EXPECT_GT(hits, kRays - 1000);
    }
  }
}

TEST(Edges, OfFoldsAreTheSameWhateverElseIsInTheScene) {
  const unsigned seed = 20261127;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const scenes::Mesh mesh = folded_slivers(random);
  expect_same_in_halves(mesh, {0.3F, -200, 100}, [&] {
    const float x = unit_of(random);
    return glm::vec3(x, unit_of(random) * kRow * kRows, 0);
  });
}

TEST(Edges, OfSharpRidgesAreTheSame) {
  const unsigned seed = 20261128;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const scenes::Mesh mesh = sharp_ridges(random);
  expect_same_in_halves(mesh, {0.3F, -200, 100}, [&] {
    const std::size_t ridge = 4 * (random() % kRows);
    const glm::vec3 on_ridge =
        glm::mix(mesh.positions[ridge], mesh.positions[ridge + 1], 0.01F + 0.98F * unit_of(random));
    return glm::mix(on_ridge, mesh.positions[ridge + 2], 0.007F * unit_of(random));
  });
}

}  // namespace
}  // namespace delray::raytrace
