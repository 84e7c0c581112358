#include "raytrace/scene/embree_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "raytrace/scene/intersection.h"
#include "raytrace/tracer.h"
#include "tests/raytrace/small_scenes.h"

namespace delray::raytrace {
namespace {

Ray ray(const glm::vec3& origin, const glm::vec3& direction) {
  Ray r;
  r.origin_x = origin.x, r.origin_y = origin.y, r.origin_z = origin.z;
  r.direction_x = direction.x, r.direction_y = direction.y, r.direction_z = direction.z;
  r.near = 0;
  return r;
}

// With packets of sixteen, eight and four rays, where the machine has them.
std::vector<std::string> instruction_sets() {
#if defined(__x86_64__)
  return {"", "sse2", "avx2"};
#else
  return {""};
#endif
}

TEST(EmbreeScene, FindsPlacementAndTriangle) {
  scenes::Scene scene;
  add(scene, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
  add(scene, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), placed(1, {0, 0, -2}));
  scene.instances.push_back({0, placed(1, {5, 0, 0})});  // makes mesh 0 an Embree instance
  const Tracer tracer = make_tracer(scene);
  EXPECT_TRUE(tracer.instances[0].instanced);
  EXPECT_FALSE(tracer.instances[1].instanced);
  const auto hit = [&](const glm::vec3& origin) {
    Ray r = ray(origin, {0, 0, -1});
    tracer.embree.intersect(r);
    EXPECT_NE(r.triangle, kMiss);
    return hit_of(r);
  };
  EXPECT_EQ(hit({0.5F, 0, 3}).instance, 0U);
  EXPECT_EQ(hit({0.5F, 0, 3}).triangle, 0U);
  EXPECT_EQ(hit({0.2F, 0.5F, 3}).triangle, 1U);
  EXPECT_EQ(hit({0.5F, 0, -1}).instance, 1U);
  EXPECT_EQ(hit({5.5F, 0, 3}).instance, 2U);
  EXPECT_FLOAT_EQ(hit({5.5F, 0, 3}).distance, 3.0F);
  Ray miss = ray({3, 0, 3}, {0, 0, -1});
  tracer.embree.intersect(miss);
  EXPECT_EQ(miss.triangle, kMiss);
}

TEST(EmbreeScene, PacketsAgreeWithSingleRays) {
  for (const std::string& isa : instruction_sets()) {
    scenes::Scene scene;
    add(scene, sphere(20));
    scene.instances.push_back({0, placed(0.5F, {1.2F, 0, 0})});
    BuildOptions options;
    options.isa = isa;
    const Tracer tracer = make_tracer(scene, options);
    for (int block = 0; block < 100; ++block) {
      RayPacket packet{};
      ActiveRays active;
      for (int i = 0; i < kPacketRays; ++i) {
        active.ray[i] = i == 5 || (i / 4 == 2 && block % 2 == 1) ? 0 : -1;
        packet.origin_x[i] = -1.5F + 0.33F * static_cast<float>(block % 10) + 0.08F * (i % 4);
        packet.origin_y[i] = -1.5F + 0.33F * static_cast<float>(block / 10) + 0.08F * (i / 4);
        packet.origin_z[i] = 5;
        packet.direction_z[i] = -1;
        packet.far[i] = std::numeric_limits<float>::infinity();
        packet.mask[i] = 0xFFFFFFFFU;
        packet.triangle[i] = packet.geometry[i] = packet.instance[i] = kMiss;
      }
      packet.direction_x[5] = std::numeric_limits<float>::quiet_NaN();
      const RayPacket sent = packet;
      tracer.embree.intersect(active, packet, block % 3 != 0);
      for (int i = 0; i < kPacketRays; ++i) {
        if (active.ray[i] == 0) {
          EXPECT_EQ(packet.triangle[i], kMiss) << isa;
          EXPECT_EQ(packet.far[i], sent.far[i]);
          continue;
        }
        Ray one = ray({packet.origin_x[i], packet.origin_y[i], 5}, {0, 0, -1});
        tracer.embree.intersect(one);
        ASSERT_EQ(packet.triangle[i] == kMiss, one.triangle == kMiss) << isa;
        if (one.triangle == kMiss) continue;
        EXPECT_EQ(hit_of(packet, i).instance, hit_of(one).instance);
        EXPECT_NEAR(packet.far[i], one.far, 1e-5);
      }
    }
  }
}

// A lattice and rays through its corners and the middles of its edges: whoever has all triangles
// finds what three that have a third of them each find together.
TEST(EmbreeScene, TriangleOfAnEdgeDoesNotDependOnWhatElseIsInTheScene) {
  constexpr int kSide = 9;
  constexpr std::size_t kParts = 3;
  scenes::Mesh lattice;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x) lattice.positions.emplace_back(x, y, 0);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const auto a = static_cast<std::uint32_t>(y * (kSide + 1) + x), b = a + kSide + 1;
      lattice.triangles.emplace_back(a, a + 1, b + 1);
      lattice.triangles.emplace_back(b + 1, b, a);
    }
  }
  std::mt19937 random(7);
  std::shuffle(lattice.triangles.begin(), lattice.triangles.end(), random);
  const glm::vec3 direction(0.5F, -0.25F, -1);
  for (const std::string& isa : instruction_sets()) {
    for (const bool instanced : {false, true}) {
      std::vector<std::uint32_t> numbers[kParts];
      scenes::Mesh part[kParts];
      for (scenes::Mesh& mesh : part) mesh.positions = lattice.positions;
      for (std::uint32_t t = 0; t < lattice.triangles.size(); ++t) {
        const std::size_t to = random() % kParts;
        numbers[to].push_back(t);
        part[to].triangles.push_back(lattice.triangles[t]);
      }
      std::deque<scenes::Scene> kept;  // tracers refer to them
      const auto tracer_of = [&](const scenes::Mesh& mesh) {
        scenes::Scene& scene = kept.emplace_back();
        add(scene, mesh);
        if (instanced) scene.instances.push_back({0, placed(1, {0, 0, -7})});
        BuildOptions options;
        options.isa = isa;
        return make_tracer(scene, options);
      };
      const Tracer whole = tracer_of(lattice);
      const Tracer some[kParts] = {tracer_of(part[0]), tracer_of(part[1]), tracer_of(part[2])};
      for (int y = 1; y < 2 * kSide; ++y) {
        for (int block = 0; block < 4; ++block) {
          const bool coherent = block % 2 == 1;
          RayPacket packet{};
          ActiveRays active;
          for (int i = 0; i < kPacketRays; ++i) {
            active.ray[i] = -1;
            packet.origin_x[i] = 0.5F * static_cast<float>(1 + block / 2 + i) - 2.5F;
            packet.origin_y[i] = 0.5F * static_cast<float>(y) + 1.25F;
            packet.origin_z[i] = 5;
            packet.direction_x[i] = direction.x;
            packet.direction_y[i] = direction.y;
            packet.direction_z[i] = direction.z;
            packet.far[i] = std::numeric_limits<float>::infinity();
            packet.mask[i] = 0xFFFFFFFFU;
            packet.triangle[i] = packet.geometry[i] = packet.instance[i] = kMiss;
          }
          const RayPacket sent = packet;
          whole.embree.intersect(active, packet, coherent);
          Hit least[kPacketRays], least_alone[kPacketRays];
          const auto take = [&](Hit hit, std::size_t k, Hit& into) {
            hit.triangle = numbers[k][hit.triangle];
            if (into.triangle == kMiss || std::tie(hit.distance, hit.instance, hit.triangle) <
                                              std::tie(into.distance, into.instance, into.triangle))
              into = hit;
          };
          for (std::size_t k = 0; k < kParts; ++k) {
            RayPacket again = sent;
            some[k].embree.intersect(active, again, coherent);
            for (int i = 0; i < kPacketRays; ++i) {
              if (again.triangle[i] != kMiss) take(hit_of(again, i), k, least[i]);
              Ray one = ray({sent.origin_x[i], sent.origin_y[i], 5}, direction);
              some[k].embree.intersect(one);
              if (one.triangle != kMiss) take(hit_of(one), k, least_alone[i]);
            }
          }
          for (int i = 0; i < kPacketRays; ++i) {
            Ray one = ray({sent.origin_x[i], sent.origin_y[i], 5}, direction);
            whole.embree.intersect(one);
            ASSERT_NE(packet.triangle[i], kMiss);
            ASSERT_EQ(packet.triangle[i], least[i].triangle) << isa << ' ' << i << ' ' << y;
            ASSERT_EQ(packet.far[i], least[i].distance);
            ASSERT_EQ(packet.u[i], least[i].u);
            ASSERT_EQ(hit_of(packet, i).instance, least[i].instance);
            ASSERT_EQ(one.triangle, least_alone[i].triangle) << isa << ' ' << i << ' ' << y;
            ASSERT_EQ(one.far, least_alone[i].distance);
          }
        }
      }
    }
  }
}

// Coherent occlusion packets have looped forever on instances with some instruction sets.
TEST(EmbreeScene, OcclusionPacketsAgreeWithSingleRays) {
  for (const std::string& isa : instruction_sets()) {
    for (const bool share : {false, true}) {
      scenes::Scene scene;
      add(scene, sphere(20));
      scene.instances.push_back({0, placed(0.5F, {1.2F, 0, 0})});
      BuildOptions options;
      options.share_meshes = share;
      options.isa = isa;
      const Tracer tracer = make_tracer(scene, options);
      for (int block = 0; block < 100; ++block) {
        ShadowPacket packet{};
        ActiveRays active;
        for (int i = 0; i < kPacketRays; ++i) {
          active.ray[i] = i % 5 == 1 ? 0 : -1;
          packet.origin_x[i] = -1.5F + 0.33F * static_cast<float>(block % 10) + 0.08F * (i % 4);
          packet.origin_y[i] = -1.5F + 0.33F * static_cast<float>(block / 10) + 0.08F * (i / 4);
          packet.origin_z[i] = 0.3F * (i % 3);
          packet.direction_x[i] = 0.1F;
          packet.direction_z[i] = -1;
          packet.far[i] = std::numeric_limits<float>::infinity();
          packet.mask[i] = 0xFFFFFFFFU;
        }
        const ShadowPacket sent = packet;
        SeeThrough passed[kPacketRays];
        tracer.embree.occluded(active, packet, passed, true);
        for (int i = 0; i < kPacketRays; ++i) {
          if (active.ray[i] == 0) {
            EXPECT_EQ(packet.far[i], sent.far[i]) << isa;
            continue;
          }
          Ray one = ray({sent.origin_x[i], sent.origin_y[i], sent.origin_z[i]}, {0.1F, 0, -1});
          SeeThrough nothing;
          EXPECT_EQ(packet.far[i] < 0, tracer.embree.occluded(one, nothing)) << isa << share;
        }
      }
    }
  }
}

TEST(EmbreeScene, OcclusionNotesWhatItSeesThrough) {
  for (const bool share : {false, true}) {
    scenes::Scene scene;
    scenes::Material& veil = add(scene, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    veil.alpha = scenes::Material::Alpha::blend;
    veil.base_colour.w = 0.5F;
    for (int i = 1; i < 5; ++i) {
      scene.instances.push_back({0, placed(1, {0, 0, -static_cast<float>(i)})});
    }
    BuildOptions options;
    options.share_meshes = share;
    options.quality = BuildOptions::Quality::high;
    const Tracer tracer = make_tracer(scene, options);
    Ray r = ray({0.3F, 0.1F, 5}, {0, 0, -1});
    SeeThrough passed;
    EXPECT_FALSE(tracer.embree.occluded(r, passed));
    EXPECT_EQ(passed.count, 5);
    r = ray({0.3F, 0.1F, 5}, {0, 0, -1});
    r.far = 6.5F;
    EXPECT_FALSE(tracer.embree.occluded(r, passed));
    EXPECT_EQ(passed.count, 2);
    for (int i = 0; i < passed.count; ++i) {
      EXPECT_NEAR(passed.hits[i].distance, 5.0F + static_cast<float>(passed.hits[i].instance),
                  1e-5);
    }
    scene.materials[0].base_colour.w = 1.0F;
    const Tracer solid = make_tracer(scene, options);
    r = ray({0.3F, 0.1F, 5}, {0, 0, -1});
    EXPECT_TRUE(solid.embree.occluded(r, passed));
    EXPECT_EQ(passed.count, 0);
  }
}

TEST(EmbreeScene, BadGeometryIsCountedAndHarmless) {
  scenes::Scene scene;
  scenes::Mesh mesh = quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  mesh.positions.insert(mesh.positions.end(),
                        {{nan, 0, 0}, {0, infinite, 0}, {0, 0, 0}, {2, 2, 0}});
  mesh.triangles.insert(mesh.triangles.end(), {{0, 1, 4}, {0, 1, 5}, {0, 6, 7}, {3, 3, 1}});
  add(scene, mesh);
  scene.meshes.emplace_back();  // no triangles
  scene.instances.push_back({1, glm::mat4x3(1.0F)});
  scene.instances.push_back({77, glm::mat4x3(1.0F)});  // no such mesh
  scene.instances.push_back({0, glm::mat4x3(0.0F)});   // flattened to a point
  const Tracer tracer = make_tracer(scene);
  EXPECT_GE(tracer.degenerate, 8U);
  Ray r = ray({0.5F, 0, 3}, {0, 0, -1});
  tracer.embree.intersect(r);
  ASSERT_NE(r.triangle, kMiss);
  EXPECT_EQ(hit_of(r).instance, 0U);
  EXPECT_EQ(hit_of(r).triangle, 0U);
}

TEST(EmbreeScene, UsesTheInstructionSetAsked) {
  scenes::Scene scene;
  add(scene, sphere(8));
#if defined(__x86_64__)
  BuildOptions options;
  options.isa = "sse2";
  const std::string isa = make_tracer(scene, options).embree.device().isa();
  EXPECT_EQ(isa.substr(0, 3), "sse");
#endif
  EXPECT_FALSE(make_tracer(scene).embree.device().version().empty());
}

TEST(Intersection, GivesPointNormalAndUv) {
  scenes::Scene scene;
  scenes::Mesh mesh = quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0});
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.tangents.assign(4, {1, 0, 0, 1});
  scenes::Texture texture;
  texture.width = texture.height = 1;
  texture.texels.resize(1);
  scene.textures.push_back(texture);
  add(scene, mesh).base_colour_texture = 0;
  glm::mat4x3 mirrored = placed(1, {0, 0, 0});
  mirrored[0].x = -1;
  scene.instances.push_back({0, mirrored});
  for (const bool share : {false, true}) {
    BuildOptions options;
    options.share_meshes = share;
    const Tracer tracer = make_tracer(scene, options);
    for (const float side : {1.0F, -1.0F}) {
      Ray r = ray({side * 1.5F, 0.5F, 3}, {0, 0, -1});
      tracer.embree.intersect(r);
      ASSERT_NE(r.triangle, kMiss);
      const Hit hit = hit_of(r);
      const Intersection at = intersection(tracer.instances[hit.instance], hit, {0, 0, -1}, {0.1F});
      EXPECT_NEAR(at.point.position.x, side * 1.5F, 1e-5);
      EXPECT_NEAR(at.point.geometric_normal.z, 1.0F, 1e-6) << side;
      EXPECT_NEAR(at.point.uv.x, 0.75F, 1e-5);
      EXPECT_NEAR(at.point.tangent.x, side, 1e-5);
      EXPECT_EQ(at.point.tangent.w, side);
      EXPECT_NEAR(at.point.footprint.dx.x, 0.05F, 1e-5);
      EXPECT_GT(at.offset, 0.0F);
      EXPECT_LT(at.offset, 1e-4F);
    }
  }
}

}  // namespace
}  // namespace delray::raytrace
