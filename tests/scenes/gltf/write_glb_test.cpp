#include "scenes/write_glb.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "files/error.h"
#include "files/read_file.h"
#include "scenes/generate.h"
#include "scenes/load.h"
#include "tests/support/temporary_folder.h"

namespace delray::scenes {
namespace {

Scene round_trip(const Scene& scene) {
  const tests::TemporaryFolder folder;
  write_glb(folder / "a.glb", scene);
  std::vector<std::string> warnings;
  Scene back = load(folder / "a.glb", warnings);
  for (const std::string& w : warnings) ADD_FAILURE() << "warning: " << w;
  return back;
}

void expect_equal(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.uvs, b.uvs);
  EXPECT_EQ(a.uvs2, b.uvs2);
  EXPECT_EQ(a.tangents, b.tangents);
  EXPECT_EQ(a.colours, b.colours);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.material, b.material);
}

void expect_equal(const Material& a, const Material& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.base_colour, b.base_colour);
  EXPECT_EQ(a.metallic, b.metallic);
  EXPECT_EQ(a.roughness, b.roughness);
  EXPECT_EQ(a.transmission, b.transmission);
  EXPECT_EQ(a.ior, b.ior);
  EXPECT_EQ(a.emission, b.emission);
  EXPECT_EQ(a.normal_scale, b.normal_scale);
  EXPECT_EQ(a.alpha, b.alpha);
  EXPECT_EQ(a.alpha_cutoff, b.alpha_cutoff);
  EXPECT_EQ(a.double_sided, b.double_sided);
  EXPECT_EQ(a.unlit, b.unlit);
  EXPECT_EQ(a.specular, b.specular);
  EXPECT_EQ(a.specular_colour, b.specular_colour);
  EXPECT_EQ(a.clearcoat, b.clearcoat);
  EXPECT_EQ(a.clearcoat_roughness, b.clearcoat_roughness);
  EXPECT_EQ(a.sheen_colour, b.sheen_colour);
  EXPECT_EQ(a.sheen_roughness, b.sheen_roughness);
  EXPECT_EQ(a.attenuation_colour, b.attenuation_colour);
  EXPECT_EQ(a.attenuation_distance, b.attenuation_distance);
  if (a.transmission > 0) {
    EXPECT_EQ(a.thickness, b.thickness);
  }
  EXPECT_EQ(a.textures(), b.textures());
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance) {
  EXPECT_LE(glm::distance(a, b), tolerance * (1 + glm::length(a)));
}

TEST(WriteGlb, GeneratedScenesComeBackWhole) {
  for (const Generator& generator : generators()) {
    SCOPED_TRACE(generator.name);
    const Scene scene = generator.generate(30'000, 2);
    const Scene back = round_trip(scene);
    ASSERT_EQ(back.meshes.size(), scene.meshes.size());
    ASSERT_EQ(back.instances.size(), scene.instances.size());
    ASSERT_EQ(back.materials.size(), scene.materials.size());
    ASSERT_EQ(back.textures.size(), scene.textures.size());
    ASSERT_EQ(back.lights.size(), scene.lights.size());
    ASSERT_EQ(back.cameras.size(), scene.cameras.size());
    // A reader may number meshes in the order in which instances show them.
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      EXPECT_EQ(back.instances[i].transform, scene.instances[i].transform);
      if (i < 40)
        expect_equal(scene.meshes[scene.instances[i].mesh], back.meshes[back.instances[i].mesh]);
    }
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
      expect_equal(scene.materials[i], back.materials[i]);
    }
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
      EXPECT_EQ(back.textures[i].texels, scene.textures[i].texels);
    }
    EXPECT_EQ(back.environment.zenith, scene.environment.zenith);
    EXPECT_EQ(back.environment.horizon, scene.environment.horizon);
    EXPECT_EQ(back.environment.ground, scene.environment.ground);
    const View a = make_view(scene.cameras[0], 640, 480), b = make_view(back.cameras[0], 640, 480);
    EXPECT_EQ(a.eye, b.eye);
    EXPECT_EQ(a.scale, b.scale);
    EXPECT_FLOAT_EQ(a.near, b.near);
    expect_near(a.forward, b.forward, 1e-6F);
    expect_near(a.up, b.up, 1e-6F);
  }
}

// Every attribute, every kind of light, textures used in all ways.
Scene everything() {
  Scene scene;
  Mesh mesh;
  mesh.name = "all";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 1, 0}};
  mesh.uvs = {{0.1F, 0.2F}, {1.7F, -3}, {0, 1}};
  mesh.uvs2 = {{0.3F, 0.1F}, {2.7F, -1}, {1, 0}};
  mesh.tangents = {{1, 0, 0, 1}, {0, 1, 0, -1}, {1, 0, 0, 1}};
  mesh.colours = {{0.1F, 0.2F, 0.3F, 0.4F}, {1, 1, 1, 1}, {0, 0, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.material = 1;
  scene.meshes.push_back(mesh);
  scene.instances.push_back({0, {{0, 2, 0}, {-2, 0, 0}, {0, 0, 2}, {0.1F, 0.2F, 0.3F}}});
  scene.instances.push_back({0, glm::mat4x3(1.0F)});
  scene.materials.resize(2);
  Material& m = scene.materials[1];
  m.name = "glass \"with\" quotes";
  m.base_colour = {0.1F, 0.2F, 0.3F, 0.4F};
  m.metallic = 0.7F;
  m.roughness = 0.3F;
  m.transmission = 0.9F;
  m.ior = 1.33F;
  m.emission = {0.1F, 7.3F, 100};
  m.normal_scale = 0.5F;
  m.alpha = Material::Alpha::mask;
  m.alpha_cutoff = 0.3F;
  m.double_sided = false;
  m.base_colour_texture = 0;
  m.metallic_roughness_texture = 1;
  m.normal_texture = 2;
  m.emission_texture = 3;
  m.unlit = true;
  m.specular = 0.6F;
  m.specular_colour = {0.1F, 1.2F, 0.3F};
  m.clearcoat = 0.4F;
  m.clearcoat_roughness = 0.2F;
  m.sheen_colour = {0.1F, 0.2F, 0.7F};
  m.sheen_roughness = 0.9F;
  m.attenuation_colour = {0.3F, 0.6F, 0.9F};
  m.attenuation_distance = 0.7F;
  m.thickness = 0.3F;
  m.transmission_texture = m.specular_texture = m.clearcoat_texture = 1;
  m.clearcoat_roughness_texture = m.sheen_roughness_texture = 2;
  m.specular_colour_texture = m.sheen_colour_texture = 3;
  using Wrap = Texture::Wrap;
  for (int i = 0; i < 4; ++i) {
    const auto value = static_cast<std::uint8_t>(60 * i);
    scene.textures.push_back({"t",
                              2,
                              1,
                              {{value, 2, 3, 255}, {4, 5, 6, 7}},
                              i == 0 || i == 3,
                              i == 1 ? Wrap::mirror : Wrap::repeat,
                              i == 2 ? Wrap::clamp : Wrap::repeat});
  }
  scene.textures[1].set = scene.textures[2].set = 1;
  scene.lights = {{Light::Kind::point, {3, 4, 5}, {1, 2, 3}, {0, 0, -1}, {}, {}},
                  {Light::Kind::directional, {0.1F, 0.2F, 0.05F}, {}, {0, -1, 0}, {}, {}},
                  {Light::Kind::area, {9, 8, 7}, {0, 3, 0}, {0, 0, -1}, {1, 0, 0}, {0, 0, 1}}};
  return scene;
}

TEST(WriteGlb, KeepsEveryAttribute) {
  const Scene scene = everything();
  const Scene back = round_trip(scene);
  ASSERT_EQ(back.meshes.size(), 1U);
  expect_equal(back.meshes[0], scene.meshes[0]);
  ASSERT_EQ(back.materials.size(), 2U);
  expect_equal(back.materials[1], scene.materials[1]);
  ASSERT_EQ(back.instances.size(), 2U);
  EXPECT_EQ(back.instances[0].transform, scene.instances[0].transform);
  ASSERT_EQ(back.textures.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(back.textures[i].texels, scene.textures[i].texels);
    EXPECT_EQ(back.textures[i].srgb, scene.textures[i].srgb);
    EXPECT_EQ(back.textures[i].wrap_u, scene.textures[i].wrap_u);
    EXPECT_EQ(back.textures[i].wrap_v, scene.textures[i].wrap_v);
    EXPECT_EQ(back.textures[i].set, scene.textures[i].set);
  }
  ASSERT_EQ(back.lights.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.lights[i].kind, scene.lights[i].kind);
    EXPECT_EQ(back.lights[i].colour, scene.lights[i].colour);
  }
  EXPECT_EQ(back.lights[0].position, glm::vec3(1, 2, 3));
  expect_near(back.lights[1].direction, {0, -1, 0}, 1e-6F);
  EXPECT_EQ(back.lights[2].edge_v, glm::vec3(0, 0, 1));
}

TEST(WriteGlb, TurnsScenesWithZUpUpright) {
  Scene scene = everything();
  scene.z_up = true;
  scene.cameras.push_back({{0, -5, 1}, {0, 0, 1}, {0, 0, 1}, 40, 0});
  scene.environment.up = {0, 0, 1};
  scene.environment.zenith = glm::vec3(1);
  const Scene back = round_trip(scene);
  EXPECT_FALSE(back.z_up);
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec4 p(scene.meshes[0].positions[k], 1);
    const glm::vec3 was = scene.instances[0].transform * p, is = back.instances[0].transform * p;
    EXPECT_EQ(is, glm::vec3(was.x, was.z, -was.y));
  }
  EXPECT_EQ(back.lights[0].position, glm::vec3(1, 3, -2));
  expect_near(back.lights[1].direction, {0, 0, 1}, 1e-6F);
  EXPECT_EQ(back.lights[2].position, glm::vec3(0, 0, -3));
  EXPECT_EQ(back.environment.up, glm::vec3(0, 1, 0));
  EXPECT_EQ(back.cameras[0].eye, glm::vec3(0, 1, 5));
  expect_near(make_view(back.cameras[0], 4, 4).forward, {0, 0, -1}, 1e-6F);
}

TEST(WriteGlb, OrthographicCamerasComeBack) {
  Scene scene = generate("gen:cornell");
  scene.cameras[0].height = 3;
  scene.cameras[0].near = 0.5F;
  scene.cameras[0].name = "plan";
  const Scene back = round_trip(scene);
  ASSERT_EQ(back.cameras.size(), 1U);
  EXPECT_EQ(back.cameras[0].height, 3);
  EXPECT_EQ(back.cameras[0].name, "plan");
  EXPECT_EQ(back.cameras[0].eye, scene.cameras[0].eye);
}

TEST(WriteGlb, WritesTheSameBytesForTheSameScene) {
  const tests::TemporaryFolder folder;
  const Scene scene = generate("gen:spheres:5000");
  write_glb(folder / "a.glb", scene);
  write_glb(folder / "b.glb", scene);
  EXPECT_EQ(files::read_file(folder / "a.glb"), files::read_file(folder / "b.glb"));
  EXPECT_EQ(folder.entries(), 2U);
}

TEST(WriteGlb, AFolderThatDoesNotExistIsADeviceError) {
  const tests::TemporaryFolder folder;
  try {
    write_glb(folder / "none" / "a.glb", everything());
    FAIL();
  } catch (const files::FileError& e) {
    EXPECT_EQ(e.cause(), files::Cause::device);
  }
}

}  // namespace
}  // namespace delray::scenes
