// A heap of overlapping glass spheres in one corner of the picture, as instances of one mesh.
#include <algorithm>
#include <cmath>

#include "scenes/generators/generators.h"
#include "scenes/generators/shapes.h"
#include "scenes/geometry/noise.h"

namespace delray::scenes::internal {
namespace {

constexpr int kSpheres = 60;
constexpr float kFloor = 60.0F;  // half side

}  // namespace

Scene generate_corner(std::uint64_t triangles, std::uint64_t seed) {
  Scene scene;
  Material glass = matte("glass", {0.98F, 1.0F, 0.99F}, 0.0F);
  glass.transmission = 1.0F;
  glass.ior = 1.5F;
  Material floor = matte("floor", {0.62F, 0.58F, 0.52F}, 0.9F);
  scene.materials = {floor, glass};

  Mesh plane;
  plane.name = "floor";
  append_quad(plane, {-kFloor, 0, kFloor}, {2 * kFloor, 0, 0}, {0, 0, -2 * kFloor}, 8);
  add_mesh(scene, std::move(plane));

  const double budget = std::max(8.0 * kSpheres, static_cast<double>(triangles) - 128);
  Mesh sphere = make_sphere(
      static_cast<std::uint32_t>(std::max(1L, std::lround(std::sqrt(budget / (8.0 * kSpheres))))));
  sphere.name = "glass sphere";
  sphere.material = 1;
  const auto mesh = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(std::move(sphere));

  // Touching and overlapping, so that a ray goes through several of them.
  Random random(seed, 1);
  for (int i = 0; i < kSpheres; ++i) {
    const float r = random.between(0.16F, 0.34F);
    const glm::vec3 centre(random.between(-3.4F, -1.9F), random.between(2.0F, 3.2F),
                           random.between(-0.9F, 0.9F));
    scene.instances.push_back(
        {mesh, glm::mat4x3(glm::vec3(r, 0, 0), glm::vec3(0, r, 0), glm::vec3(0, 0, r), centre)});
  }

  Light key;
  key.colour = glm::vec3(1.0F, 0.97F, 0.92F) * 2.2F;
  key.direction = glm::normalize(glm::vec3(0.4F, -0.9F, -0.5F));
  scene.lights = {key};
  scene.environment.zenith = {0.15F, 0.28F, 0.58F};
  scene.environment.horizon = {0.55F, 0.66F, 0.80F};
  scene.environment.ground = {0.16F, 0.13F, 0.11F};
  Camera camera;
  camera.eye = {0.0F, 1.4F, 7.5F};
  camera.at = {0.0F, 1.4F, 0.0F};
  camera.vertical_fov = 32.0F;
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace delray::scenes::internal
