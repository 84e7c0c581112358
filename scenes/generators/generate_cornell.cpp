// The Cornell box (Goral et al. 1984), with the lamp a little below the ceiling in a frame of its
// own, so that neither surface hides the other. Rectangles are divided evenly; the lamp's frame is
// not.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/generators/generators.h"
#include "scenes/generators/shapes.h"

namespace delray::scenes::internal {
namespace {

constexpr float kSide = 5.55F;        // of the box
constexpr std::uint64_t kQuads = 16;  // five walls, the light, two blocks of five faces
constexpr std::uint64_t kFrame = 4;   // and as many that are never divided
constexpr glm::vec3 kLightRadiance{27.0F, 22.5F, 15.5F};

// Five faces of an upright block: all but the bottom. `along` is the horizontal edge from `corner`,
// the other one is at its right angle, to the left seen from above.
Mesh block(const glm::vec3& corner, const glm::vec2& along, float height, std::uint32_t n) {
  const glm::vec3 u(along.x, 0, along.y), v(along.y, 0, -along.x), up(0, height, 0);
  Mesh mesh;
  append_quad(mesh, corner, u, up, n);
  append_quad(mesh, corner + u, v, up, n);
  append_quad(mesh, corner + u + v, -u, up, n);
  append_quad(mesh, corner + v, -v, up, n);
  append_quad(mesh, corner + up, u, v, n);
  return mesh;
}

Mesh wall(const char* name, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v,
          std::uint32_t n, std::uint32_t material) {
  Mesh mesh;
  mesh.name = name;
  mesh.material = material;
  append_quad(mesh, corner, u, v, n);
  return mesh;
}

}  // namespace

Scene generate_cornell(std::uint64_t triangles, std::uint64_t /*seed*/) {
  const double cells =
      std::sqrt(std::max(0.0, static_cast<double>(triangles) - 2.0 * kFrame) / (2.0 * kQuads));
  const auto n = static_cast<std::uint32_t>(std::max(1L, std::lround(cells)));
  enum : std::uint32_t { kWhite, kRed, kGreen, kLamp };
  Scene scene;
  scene.materials = {matte("white", {0.73F, 0.73F, 0.73F}), matte("red", {0.65F, 0.05F, 0.05F}),
                     matte("green", {0.12F, 0.45F, 0.15F}), matte("lamp", {0.78F, 0.78F, 0.78F})};
  scene.materials[kLamp].emission = kLightRadiance;
  scene.materials[kLamp].double_sided = false;

  constexpr float s = kSide;
  const glm::vec3 x(s, 0, 0), y(0, s, 0), z(0, 0, s);
  add_mesh(scene, wall("floor", z, x, -z, n, kWhite));
  add_mesh(scene, wall("ceiling", y, x, z, n, kWhite));
  add_mesh(scene, wall("back", glm::vec3(0), x, y, n, kWhite));
  add_mesh(scene, wall("left", z, -z, y, n, kRed));
  add_mesh(scene, wall("right", x, z, y, n, kGreen));
  // The lamp hangs a little below the ceiling, so that neither hides the other, in a frame that
  // keeps in what its back sheds.
  const glm::vec3 lamp(2.13F, s - 0.01F, 2.27F), lamp_u(1.3F, 0, 0), lamp_v(0, 0, 1.05F);
  const glm::vec3 up(0, s - lamp.y, 0);
  add_mesh(scene, wall("lamp", lamp, lamp_u, lamp_v, n, kLamp));
  Mesh frame;
  frame.name = "frame";
  append_quad(frame, lamp + lamp_v, lamp_u, up, 1);
  append_quad(frame, lamp + lamp_u + lamp_v, -lamp_v, up, 1);
  append_quad(frame, lamp + lamp_u, -lamp_u, up, 1);
  append_quad(frame, lamp, lamp_v, up, 1);
  add_mesh(scene, std::move(frame));
  Mesh low = block({2.75F, 0, 4.60F}, {1.60F, -0.47F}, 1.65F, n);
  low.name = "low block";
  add_mesh(scene, std::move(low));
  Mesh high = block({0.80F, 0, 2.75F}, {1.58F, 0.49F}, 3.30F, n);
  high.name = "high block";
  add_mesh(scene, std::move(high));

  Light light;
  light.kind = Light::Kind::area;
  light.colour = kLightRadiance;
  light.position = lamp;
  light.edge_u = lamp_u;
  light.edge_v = lamp_v;
  scene.lights.push_back(light);
  // The light that is reflected more than once, for renderers that do not follow it.
  scene.environment.zenith = scene.environment.horizon = scene.environment.ground =
      glm::vec3(0.06F);
  Camera camera;
  camera.eye = {s / 2, s / 2, s + 8.0F};
  camera.at = {s / 2, s / 2, 0};
  camera.vertical_fov = 39.5F;
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace delray::scenes::internal
