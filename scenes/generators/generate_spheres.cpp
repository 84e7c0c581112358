// Spheres of glass, metal and other materials over a chequered plane, after Whitted (1980). Small
// ones are placed by rejection sampling, so that none touches another, and are fewer where no place
// is found.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/generators/generators.h"
#include "scenes/generators/shapes.h"
#include "scenes/geometry/noise.h"

namespace delray::scenes::internal {
namespace {

constexpr int kSmallSpheres = 24;
constexpr float kPlane = 40.0F;  // half side of the plane; spheres have radii up to 1

Texture chequers() {
  constexpr int kSize = 256;  // two by two fields
  constexpr image::Rgba8 kLight{236, 226, 198, 255}, kDark{150, 34, 28, 255};
  Texture texture;
  texture.name = "chequers";
  texture.width = texture.height = kSize;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      texture.texels.push_back((x < kSize / 2) == (y < kSize / 2) ? kLight : kDark);
    }
  }
  return texture;
}

Mesh plane() {
  Mesh mesh;
  mesh.name = "plane";
  append_quad(mesh, {-kPlane, 0, kPlane}, {2 * kPlane, 0, 0}, {0, 0, -2 * kPlane}, 16);
  for (const glm::vec3& p : mesh.positions) {
    mesh.uvs.push_back(glm::vec2(p.x, p.z) * 0.5F);
  }
  return mesh;
}

Material metal(const char* name, const glm::vec3& colour, float roughness) {
  Material material = matte(name, colour, roughness);
  material.metallic = 1.0F;
  return material;
}

Material glass(const char* name, const glm::vec3& colour) {
  Material material = matte(name, colour, 0.0F);
  material.transmission = 1.0F;
  material.ior = 1.5F;
  return material;
}

struct Ball {
  glm::vec3 centre;
  float radius;
};

// Small spheres lie on the plane around the large ones, without touching.
std::vector<Ball> scatter_balls(std::vector<Ball> balls, std::uint64_t seed) {
  Random random(seed, 1);
  const std::size_t wanted = balls.size() + kSmallSpheres;
  for (int attempt = 0; attempt < 4000 && balls.size() < wanted; ++attempt) {
    const float radius = random.between(0.12F, 0.3F);
    const float x = random.between(-3.4F, 3.4F), z = random.between(-3.0F, 2.6F);
    const glm::vec3 centre(x, radius, z);
    const bool free = std::none_of(balls.begin(), balls.end(), [&](const Ball& b) {
      return glm::distance(b.centre, centre) < b.radius + radius + 0.06F;
    });
    if (free) balls.push_back({centre, radius});
  }
  return balls;
}

}  // namespace

Scene generate_spheres(std::uint64_t triangles, std::uint64_t seed) {
  Scene scene;
  scene.textures.push_back(chequers());
  Material floor = matte("chequers", glm::vec3(1.0F), 0.7F);
  floor.base_colour_texture = 0;
  scene.materials = {floor,
                     glass("glass", {1.0F, 1.0F, 1.0F}),
                     metal("mirror", {0.95F, 0.95F, 0.96F}, 0.0F),
                     metal("gold", {1.0F, 0.72F, 0.30F}, 0.2F),
                     matte("blue", {0.05F, 0.16F, 0.55F}, 0.3F),
                     glass("green glass", {0.75F, 0.95F, 0.80F}),
                     matte("white", {0.82F, 0.80F, 0.76F}, 0.5F)};
  const std::vector<Ball> balls = scatter_balls({{{-0.35F, 1.05F, 0.75F}, 0.8F},
                                                 {{1.25F, 1.0F, -0.75F}, 1.0F},
                                                 {{-1.9F, 0.75F, -1.1F}, 0.75F},
                                                 {{1.75F, 0.5F, 1.05F}, 0.5F}},
                                                seed);

  add_mesh(scene, plane());
  const double budget = static_cast<double>(triangles) - 512;
  const double cells = std::sqrt(std::max(8.0, budget) / (8.0 * static_cast<double>(balls.size())));
  const Mesh sphere = make_sphere(static_cast<std::uint32_t>(std::max(1L, std::lround(cells))));
  const auto first_mesh = static_cast<std::uint32_t>(scene.meshes.size());
  for (std::uint32_t material = 1; material < scene.materials.size(); ++material) {
    scene.meshes.push_back(sphere);
    scene.meshes.back().name = scene.materials[material].name + " sphere";
    scene.meshes.back().material = material;
  }
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const auto kind = static_cast<std::uint32_t>(i % (scene.materials.size() - 1));
    const float r = balls[i].radius;
    scene.instances.push_back(
        {first_mesh + kind,
         glm::mat4x3(glm::vec3(r, 0, 0), glm::vec3(0, r, 0), glm::vec3(0, 0, r), balls[i].centre)});
  }

  Light key;
  key.colour = glm::vec3(1.0F, 0.97F, 0.92F) * 2.4F;
  key.direction = glm::normalize(glm::vec3(0.55F, -0.9F, -0.6F));
  Light lamp;
  lamp.kind = Light::Kind::point;
  lamp.position = {3.5F, 4.0F, 3.0F};
  lamp.colour = glm::vec3(0.8F, 0.9F, 1.0F) * 9.0F;
  scene.lights = {key, lamp};
  scene.environment.zenith = {0.13F, 0.26F, 0.58F};
  scene.environment.horizon = {0.55F, 0.66F, 0.80F};
  scene.environment.ground = {0.16F, 0.13F, 0.11F};
  Camera camera;
  camera.eye = {0.2F, 1.75F, 6.2F};
  camera.at = {0.05F, 0.75F, 0.0F};
  camera.vertical_fov = 38.0F;
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace delray::scenes::internal
