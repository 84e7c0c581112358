#include "scenes/generate.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include "parallel/arena.h"

namespace delray::scenes {
namespace {

constexpr std::uint64_t kTriangles = 60'000;  // fine enough for every kind to come near it

const Generator& generator(std::string_view name) {
  for (const Generator& g : generators()) {
    if (name == g.name) return g;
  }
  throw std::logic_error("no such generator");
}

// A sum over all coordinates that changes with any bit and with the order.
std::uint64_t fingerprint(const Scene& scene) {
  std::uint64_t hash = 1469598103934665603U;
  const auto add = [&hash](std::uint64_t x) { hash = (hash ^ x) * 1099511628211U; };
  const auto add_float = [&](float x) { add(std::bit_cast<std::uint32_t>(x)); };
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::vec3& p : mesh.positions) add_float(p.x), add_float(p.y), add_float(p.z);
    for (const glm::vec3& n : mesh.normals) add_float(n.x), add_float(n.y), add_float(n.z);
    for (const glm::vec4& c : mesh.colours) add_float(c.x), add_float(c.y), add_float(c.z);
    for (const glm::uvec3& t : mesh.triangles) add(t.x), add(t.y), add(t.z);
  }
  for (const Instance& instance : scene.instances) {
    add(instance.mesh);
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 3; ++row) add_float(instance.transform[column][row]);
    }
  }
  return hash;
}

class Generated : public testing::TestWithParam<Generator> {};

TEST(GeneratedName, TellsWhatWasLeftToTheDefaults) {
  EXPECT_EQ(full_name("gen:city:300:7"), "gen:city:300:7");
  EXPECT_EQ(full_name("gen:city:300"), "gen:city:300:1");
  EXPECT_EQ(full_name("gen:terrain"), "gen:terrain:1000000:1");
  EXPECT_EQ(full_name("gen:city:2.5e5:1k"), "gen:city:250000:1000");
  for (const char* name : {"gen:nothing", "gen:city:2.5", "gen:city:0", "gen:city:2e9",
                           "gen:city:1e30", "gen:city:-1", "gen:city:10:x"}) {
    EXPECT_THROW(full_name(name), std::invalid_argument) << name;
  }
}

TEST_P(Generated, HasAboutAsManyTrianglesAsAskedFor) {
  for (const std::uint64_t wanted : {kTriangles, 4 * kTriangles}) {
    const auto count = static_cast<double>(triangle_count(GetParam().generate(wanted, 1)));
    EXPECT_NEAR(count / static_cast<double>(wanted), 1.0, 0.06) << wanted;
  }
}

TEST_P(Generated, IsAValidScene) {
  const Scene scene = GetParam().generate(kTriangles, 3);
  ASSERT_FALSE(scene.meshes.empty());
  EXPECT_FALSE(scene.z_up);
  EXPECT_FALSE(scene.lights.empty());
  for (const Instance& instance : scene.instances) {
    ASSERT_LT(instance.mesh, scene.meshes.size());
    EXPECT_GT(glm::determinant(glm::mat3(instance.transform)), 0);
  }
  for (const Mesh& mesh : scene.meshes) {
    ASSERT_LT(mesh.material, scene.materials.size());
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    EXPECT_TRUE(mesh.colours.empty() || mesh.colours.size() == mesh.positions.size());
    EXPECT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
    for (const glm::vec3& n : mesh.normals) ASSERT_NEAR(glm::length(n), 1, 1e-5) << mesh.name;
    std::size_t inverted = 0, flat = 0;
    for (const glm::uvec3& t : mesh.triangles) {
      ASSERT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size()) << mesh.name;
      const glm::dvec3 p(mesh.positions[t.x]);
      const glm::dvec3 area =
          glm::cross(glm::dvec3(mesh.positions[t.y]) - p, glm::dvec3(mesh.positions[t.z]) - p);
      const glm::vec3 normal = mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z];
      flat += glm::length(area) > 0 ? 0 : 1;
      inverted += glm::dot(area, glm::dvec3(normal)) < 0 ? 1 : 0;
    }
    EXPECT_EQ(flat, 0U) << mesh.name;
    // A vertex normal may look away from a sliver of a rough surface.
    EXPECT_LE(inverted * 200, mesh.triangles.size()) << mesh.name;
  }
}

TEST_P(Generated, IsTheSameForTheSameSeedAndAnyThreads) {
  parallel::Arena one(1), two(2);
  const auto make = [&](parallel::Arena& arena, std::uint64_t seed) {
    return arena.execute([&] { return fingerprint(GetParam().generate(20'000, seed)); });
  };
  EXPECT_EQ(make(one, 5), make(two, 5));
  const std::set<std::string_view> fixed = {"cornell", "machine", "cloth", "arm"};
  const bool has_random_parts = !fixed.contains(GetParam().name);
  EXPECT_EQ(make(one, 5) != make(one, 6), has_random_parts);
}

TEST_P(Generated, IsValidWithFewTriangles) {
  for (const std::uint64_t wanted : {1, 2, 3, 10, 100, 1000}) {
    const Scene scene = GetParam().generate(wanted, 1);
    EXPECT_GT(triangle_count(scene), 0U) << wanted;
    EXPECT_FALSE(bounds(scene).empty()) << wanted;
  }
}

TEST_P(Generated, LooksAtItself) {
  const Scene scene = GetParam().generate(kTriangles, 1);
  ASSERT_FALSE(scene.cameras.empty());
  const View view = make_view(scene.cameras[0], 1920, 1080);
  std::size_t visible = 0, all = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (std::size_t i = 0; i < mesh.positions.size(); i += 17) {
      const glm::vec3 v = instance.transform * glm::vec4(mesh.positions[i], 1) - view.eye;
      const float depth = glm::dot(v, view.forward);
      const float x = view.half_width + glm::dot(v, view.right) / depth * view.scale;
      const float y = view.half_height - glm::dot(v, view.up) / depth * view.scale;
      visible += depth > view.near && x >= 0 && x < 1920 && y >= 0 && y < 1080 ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GT(visible * 8, all) << visible << " of " << all;
}

INSTANTIATE_TEST_SUITE_P(Generate, Generated, testing::ValuesIn(generators()),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(Generate, FieldHasThirteenMillionTrianglesIn1008Instances) {
  const Generator& field = generator("field");
  const Scene scene = field.generate(field.default_triangles, 1);
  EXPECT_NEAR(static_cast<double>(triangle_count(scene)), 13e6, 0.2e6);
  EXPECT_EQ(scene.instances.size(), 1009U);  // and the ground
}

// How far a ray gets; infinity where it meets nothing (Moller and Trumbore 1997).
double way(const Scene& scene, const glm::dvec3& from, const glm::dvec3& direction) {
  double least = std::numeric_limits<double>::infinity();
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::dvec3 a(mesh.positions[t.x]), ab = glm::dvec3(mesh.positions[t.y]) - a,
                                               ac = glm::dvec3(mesh.positions[t.z]) - a;
      const glm::dvec3 p = glm::cross(direction, ac), d = from - a, q = glm::cross(d, ab);
      const double det = glm::dot(ab, p);
      if (std::abs(det) < 1e-12) continue;
      const double u = glm::dot(d, p) / det, v = glm::dot(direction, q) / det;
      const double distance = glm::dot(ac, q) / det;
      if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0) least = std::min(least, distance);
    }
  }
  return least;
}

// Light from the back of the lamp, through a gap that few paths find, would be noise for ever.
TEST(Generate, TheLampOfTheCornellBoxShinesDownwardsAlone) {
  for (const char* name : {"gen:cornell", "gen:cornell:1000"}) {
    const Scene scene = generate(name);
    const Light& lamp = scene.lights.at(0);
    const glm::dvec3 u(lamp.edge_u), v(lamp.edge_v);
    const glm::dvec3 above = glm::dvec3(lamp.position) + (u + v) * 0.5 + glm::dvec3(0, 0.004, 0);
    for (const glm::dvec3& edge : {u, -u, v, -v})
      EXPECT_NEAR(way(scene, above, glm::normalize(edge)), 0.5 * glm::length(edge), 1e-3) << name;
    EXPECT_LT(way(scene, above, {0, 1, 0}), 0.02) << name;
  }
}

TEST(Generate, ReadsKindTrianglesAndSeedFromTheName) {
  const std::uint64_t plain = fingerprint(generator("terrain").generate(5000, 7));
  EXPECT_EQ(fingerprint(generate("gen:terrain:5000:7")), plain);
  EXPECT_EQ(triangle_count(generate("gen:cornell")), 40U);
  EXPECT_TRUE(is_generated("gen:city"));
  EXPECT_FALSE(is_generated("city.glb"));
}

TEST(Generate, RefusesWhatItDoesNotKnow) {
  for (const char* name : {"gen:", "gen:teapot", "gen:city:x", "gen:city:10:1:2", "gen:city:0",
                           "gen:city:-5", "gen:city:99999999999", "city"}) {
    try {
      generate(name);
      FAIL() << name;
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find("terrain cornell spheres city field"),
                std::string::npos);
    }
  }
}

TEST(GeneratedParts, AreTheWholeScene) {
  const std::string name = "gen:terrain:30000:5";
  ASSERT_TRUE(has_parts(name));
  EXPECT_FALSE(has_parts("gen:city"));
  EXPECT_FALSE(has_parts("a.glb"));
  const Scene whole = generate(name);
  const Mesh& mesh = whole.meshes[0];
  for (const int parts : {1, 3, 8, 200}) {
    std::size_t next = 0;
    for (int part = 0; part < parts; ++part) {
      const ScenePart mine = generate_part(name, part, parts);
      EXPECT_EQ(mine.triangles, mesh.triangles.size());
      EXPECT_EQ(mine.vertices, mesh.positions.size());
      EXPECT_EQ(mine.scene.lights.size(), whole.lights.size());
      const Mesh& piece = mine.scene.meshes[0];
      if (!piece.triangles.empty()) {
        EXPECT_EQ(mine.first_triangle, next);
      }
      for (const glm::uvec3& t : piece.triangles) {
        const glm::uvec3& same = mesh.triangles.at(next++);
        for (int k = 0; k < 3; ++k) {
          ASSERT_EQ(piece.positions[t[k]], mesh.positions[same[k]]);
          ASSERT_EQ(piece.normals[t[k]], mesh.normals[same[k]]);
          ASSERT_EQ(piece.colours[t[k]], mesh.colours[same[k]]);
        }
      }
    }
    EXPECT_EQ(next, mesh.triangles.size()) << parts;
  }
}

}  // namespace
}  // namespace delray::scenes
