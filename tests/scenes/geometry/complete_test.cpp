#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/scene.h"

namespace delray::scenes {
namespace {

// The cube [-1, 1]^3 with shared corners; its faces' normals point outwards.
Mesh cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1,
                                (i & 4) != 0 ? 1 : -1);
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Scene with_mesh(Mesh mesh) {
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.emplace_back();
  return scene;
}

glm::vec3 face_normal(const Mesh& mesh, const glm::uvec3& t) {
  const glm::vec3 p = mesh.positions[t.x];
  return glm::normalize(glm::cross(mesh.positions[t.y] - p, mesh.positions[t.z] - p));
}

TEST(Complete, SplitsACubeAlongItsEdgesOnly) {
  Scene scene = with_mesh(cube());
  complete(scene, Camera{}, 60);
  const Mesh& mesh = scene.meshes[0];
  EXPECT_EQ(mesh.positions.size(), 24U);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT(glm::distance(mesh.normals[t[k]], face_normal(mesh, t)), 1e-6F);
    }
  }
}

TEST(Complete, SmoothsACubeWhereNoAngleIsACrease) {
  Scene scene = with_mesh(cube());
  complete(scene, Camera{}, 120);
  const Mesh& mesh = scene.meshes[0];
  ASSERT_EQ(mesh.positions.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_GT(glm::dot(mesh.normals[i], glm::normalize(mesh.positions[i])), 0.8F);
  }
}

TEST(Complete, NormalsOfASphereAreItsDirections) {
  // As triangles that share nothing, as STL has them.
  const Scene generated = generate("gen:spheres:20000");
  const Mesh& sphere = generated.meshes[1];
  Mesh loose;
  for (const glm::uvec3& t : sphere.triangles) {
    const auto first = static_cast<std::uint32_t>(loose.positions.size());
    for (int k = 0; k < 3; ++k) loose.positions.push_back(sphere.positions[t[k]]);
    loose.triangles.emplace_back(first, first + 1, first + 2);
  }
  Scene scene = with_mesh(loose);
  complete(scene, Camera{});
  ASSERT_EQ(scene.meshes[0].positions.size(), loose.positions.size());
  for (std::size_t i = 0; i < loose.positions.size(); ++i) {
    ASSERT_GT(glm::dot(scene.meshes[0].normals[i], loose.positions[i]), 0.99F);
  }
}

TEST(Complete, DegenerateTrianglesGetSomeUnitNormal) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 4, 2}};
  Scene scene = with_mesh(mesh);
  complete(scene, Camera{});
  ASSERT_EQ(scene.meshes[0].normals.size(), scene.meshes[0].positions.size());
  for (const glm::vec3& n : scene.meshes[0].normals) EXPECT_NEAR(glm::length(n), 1, 1e-6);
  const std::uint32_t corner = scene.meshes[0].triangles[1].z;
  EXPECT_EQ(scene.meshes[0].normals[corner], glm::vec3(0, 0, 1));
}

TEST(Complete, AFanOfThousandsOfTrianglesAroundOneVertexIsSmooth) {
  constexpr std::uint32_t kSides = 20'000;
  Mesh mesh;
  mesh.positions.emplace_back(0, 0, 0.1F);
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    mesh.triangles.emplace_back(0, i + 1, (i + 1) % kSides + 1);
  }
  Scene scene = with_mesh(mesh);
  complete(scene, Camera{});
  EXPECT_EQ(scene.meshes[0].positions.size(), mesh.positions.size());
  EXPECT_LT(glm::distance(scene.meshes[0].normals[0], glm::vec3(0, 0, 1)), 1e-4F);
}

TEST(Complete, KeepsNormalsLightsAndMaterialsThatAreThere) {
  Scene scene = generate("gen:cornell");
  const Scene before = scene;
  complete(scene, scene.cameras[0]);
  EXPECT_EQ(scene.lights.size(), before.lights.size());
  EXPECT_EQ(scene.materials.size(), before.materials.size());
  EXPECT_EQ(scene.environment.zenith, before.environment.zenith);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    EXPECT_EQ(scene.meshes[i].normals, before.meshes[i].normals);
  }
}

TEST(Complete, IsIdempotent) {
  Scene once = with_mesh(cube());
  const Camera camera = camera_around(bounds(once), "default", false, 1.5F);
  complete(once, camera);
  Scene twice = once;
  complete(twice, camera);
  EXPECT_EQ(twice.meshes[0].positions, once.meshes[0].positions);
  EXPECT_EQ(twice.meshes[0].normals, once.meshes[0].normals);
  EXPECT_EQ(twice.lights.size(), once.lights.size());
  EXPECT_EQ(twice.materials.size(), once.materials.size());
}

// A floor of 10 x 10 and a square of 1 x 1 above it that glows.
Scene lit_by_glow(float radiance) {
  Mesh floor;
  floor.positions = {{-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  Mesh lamp = floor;
  for (glm::vec3& p : lamp.positions) p = p * 0.1F + glm::vec3(0, 2, 0);
  lamp.material = 1;
  Scene scene;
  scene.meshes = {floor, lamp};
  scene.instances = {{0, glm::mat4x3(1.0F)}, {1, glm::mat4x3(1.0F)}};
  scene.materials.resize(2);
  scene.materials[1].emission = glm::vec3(radiance);
  return scene;
}

TEST(Complete, AddsNoLightToWhatGlowLights) {
  for (const float radiance : {1.0F, 20.0F}) {
    Scene scene = lit_by_glow(radiance);
    complete(scene, Camera{});
    EXPECT_TRUE(scene.lights.empty()) << radiance;
    EXPECT_EQ(scene.environment.zenith, glm::vec3(0.0F)) << radiance;
  }
}

TEST(Complete, GlowThatLightsNothingVisiblyIsNoLight) {
  Scene faint = lit_by_glow(0.01F);
  EXPECT_FALSE(is_lit_by_emission(faint));
  complete(faint, Camera{});
  EXPECT_EQ(faint.lights.size(), 1U);
  // A screen; brighter than white it is a lamp.
  Scene screen = lit_by_glow(1.0F);
  screen.textures.push_back({"screen", 1, 1, {{255, 255, 255, 255}}});
  screen.materials[1].emission_texture = 0;
  EXPECT_FALSE(is_lit_by_emission(screen));
  screen.materials[1].emission = glm::vec3(4.0F);
  EXPECT_TRUE(is_lit_by_emission(screen));
  Scene unlit = lit_by_glow(1.0F);
  unlit.materials[1].unlit = true;
  EXPECT_FALSE(is_lit_by_emission(unlit));
}

TEST(Complete, DefaultLightHasAStrength) {
  Scene one = with_mesh(cube()), half = one;
  add_default_light(one, Camera{});
  add_default_light(half, Camera{}, 0.5F);
  EXPECT_EQ(half.lights[0].colour, one.lights[0].colour * 0.5F);
  EXPECT_EQ(half.environment.horizon, one.environment.horizon * 0.5F);
}

// What a diffuse surface of albedo 0.8 with normal n sends back under the key light and a sky whose
// radiance is linear in height: half of the upper and lower hemisphere at right angles to up.
TEST(Complete, LightsAGreySurfaceThatFacesTheKeyLightToThreeQuarters) {
  Scene scene = with_mesh(cube());
  for (const bool z_up : {false, true}) {
    scene.lights.clear();
    scene.environment = {};
    scene.z_up = z_up;
    complete(scene, camera_around(bounds(scene), "default", z_up, 1.5F));
    ASSERT_EQ(scene.lights.size(), 1U);
    const Light& key = scene.lights[0];
    ASSERT_EQ(key.kind, Light::Kind::directional);
    const glm::dvec3 n(-key.direction);
    const glm::dvec3 up(scene.environment.up);
    EXPECT_GT(glm::dot(n, up), 0.3);
    glm::dvec3 sky(0);
    constexpr int kSteps = 400;
    double weight = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const double height = -1 + 2 * (i + 0.5) / kSteps,
                     angle = 2 * std::numbers::pi * j / kSteps;
        const double level = std::sqrt(1 - height * height);
        const glm::dvec3 d =
            z_up ? glm::dvec3(level * std::cos(angle), level * std::sin(angle), height)
                 : glm::dvec3(level * std::cos(angle), height, level * std::sin(angle));
        const double cosine = glm::dot(n, d);
        if (cosine <= 0) continue;
        const Environment& e = scene.environment;
        sky += cosine * glm::mix(glm::dvec3(e.horizon),
                                 glm::dvec3(height > 0 ? e.zenith : e.ground), std::abs(height));
        weight += cosine;
      }
    }
    const glm::dvec3 out = 0.8 * (glm::dvec3(key.colour) / std::numbers::pi + sky / weight);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(out[k], 0.75, 0.05);
  }
}

TEST(Complete, AddsTangentsForNormalTexturesAndSplitsMirroredOnes) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
  // v grows downwards; the right half repeats the left one mirrored.
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0, 1}, {0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  Scene scene = with_mesh(mesh);
  Material material;
  material.normal_texture = 0;
  scene.materials.push_back(material);
  scene.textures.push_back({"flat", 1, 1, {{128, 128, 255, 255}}, false});
  complete(scene, Camera{});
  const Mesh& done = scene.meshes[0];
  EXPECT_EQ(done.positions.size(), 8U);
  ASSERT_EQ(done.tangents.size(), done.positions.size());
  EXPECT_EQ(done.tangents[0], glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(done.tangents[4], glm::vec4(-1, 0, 0, -1));
  for (std::size_t i = 0; i < done.tangents.size(); ++i) {
    // The bitangent points up the texture, against v.
    const glm::vec3 bitangent =
        done.tangents[i].w * glm::cross(done.normals[i], glm::vec3(done.tangents[i]));
    EXPECT_EQ(bitangent, glm::vec3(0, 1, 0)) << i;
  }
}

TEST(Complete, TangentsFollowTheSetOfTheNormalTexture) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.uvs = {{0, 1}, {1, 1}, {0, 0}};
  mesh.uvs2 = {{0, 0}, {0, 1}, {1, 0}};  // u grows upwards
  mesh.triangles = {{0, 1, 2}};
  Scene scene = with_mesh(mesh);
  scene.materials.resize(1);
  scene.materials[0].normal_texture = 0;
  scene.textures.push_back({"flat", 1, 1, {{128, 128, 255, 255}}, false});
  scene.textures[0].set = 1;
  complete(scene, Camera{});
  ASSERT_EQ(scene.meshes[0].tangents.size(), 3U);
  EXPECT_EQ(glm::vec3(scene.meshes[0].tangents[0]), glm::vec3(0, 1, 0));
}

TEST(Complete, AnEmptySceneStaysEmptyAndGetsAMaterial) {
  Scene scene;
  complete(scene, Camera{});
  EXPECT_EQ(scene.materials.size(), 1U);
  EXPECT_TRUE(bounds(scene).empty());
  EXPECT_EQ(triangle_count(scene), 0U);
  EXPECT_EQ(first_primitives(scene), std::vector<std::uint64_t>{0});
}

}  // namespace
}  // namespace delray::scenes
