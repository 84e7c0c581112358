// Scenes of a few triangles whose pictures are known.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "comm/threads.h"
#include "raytrace/render.h"
#include "scenes/scene.h"

namespace delray::raytrace {

// A parallelogram corner + s * u + t * v, facing cross(u, v).
inline scenes::Mesh quad(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v) {
  scenes::Mesh mesh;
  mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// A unit sphere around the origin with smooth normals.
inline scenes::Mesh sphere(int rows = 32) {
  scenes::Mesh mesh;
  const int columns = 2 * rows;
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j <= columns; ++j) {
      const double theta = M_PI * i / rows, phi = 2 * M_PI * j / columns;
      mesh.positions.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                                  -std::sin(theta) * std::sin(phi));
    }
  }
  mesh.normals = mesh.positions;
  for (glm::vec3& n : mesh.normals) n = glm::normalize(n);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const auto a = static_cast<std::uint32_t>(i * (columns + 1) + j);
      const auto b = a + static_cast<std::uint32_t>(columns + 1);
      if (i > 0) mesh.triangles.emplace_back(a, b, a + 1);
      if (i + 1 < rows) mesh.triangles.emplace_back(a + 1, b, b + 1);
    }
  }
  return mesh;
}

// Adds a mesh with a material of its own, placed once.
inline scenes::Material& add(scenes::Scene& scene, scenes::Mesh mesh,
                             const glm::mat4x3& transform = glm::mat4x3(1.0F)) {
  mesh.material = static_cast<std::uint32_t>(scene.materials.size());
  scene.instances.push_back({static_cast<std::uint32_t>(scene.meshes.size()), transform});
  scene.meshes.push_back(std::move(mesh));
  return scene.materials.emplace_back();
}

inline glm::mat4x3 placed(float scale, const glm::vec3& at) {
  glm::mat4x3 m(0.0F);
  m[0].x = m[1].y = m[2].z = scale;
  m[3] = at;
  return m;
}

// Mirrors, glass, veils and cut-outs over a floor, under a sky and three kinds of light.
inline scenes::Scene mixture() {
  scenes::Scene scene;
  add(scene, quad({-6, -1, 6}, {12, 0, 0}, {0, 0, -12}));
  scenes::Material& mirror = add(scene, sphere(12), placed(1, {-1.2F, 0, 0}));
  mirror.metallic = 1;
  mirror.roughness = 0.1F;
  scenes::Material& glass = add(scene, sphere(12), placed(0.8F, {1, -0.1F, 0.5F}));
  glass.transmission = 1;
  glass.roughness = 0;
  scene.instances.push_back({2, placed(0.3F, {0, 1.2F, 0})});
  scenes::Material& veil = add(scene, quad({-2, -1, 2}, {3, 0, 0}, {0, 1.3F, 0}));
  veil.alpha = scenes::Material::Alpha::blend;
  veil.base_colour.w = 0.4F;
  scenes::Material& lamp = add(scene, quad({-1, 3, -1}, {0, 0, 1}, {1, 0, 0}));
  lamp.emission = glm::vec3(5);
  scenes::Light light;
  light.direction = {0.3F, -1, -0.4F};
  scene.lights.push_back(light);
  light.kind = scenes::Light::Kind::point;
  light.position = {2, 2, 3};
  light.colour = glm::vec3(8);
  scene.lights.push_back(light);
  scene.environment.zenith = {0.2F, 0.3F, 0.6F};
  scene.environment.horizon = {0.4F, 0.4F, 0.4F};
  return scene;
}

// On one rank with one thread.
inline Result render_alone(const scenes::Scene& scene, const scenes::Camera& camera,
                           const RenderOptions& options) {
  Result result;
  comm::run_threads(1, 1, [&](comm::Communicator& communicator) {
    result = render(communicator, scene, camera, options);
  });
  return result;
}

inline RenderOptions small(int width = 32, int height = 32) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  return options;
}

inline image::RgbaF pixel(const Result& result, int x, int y) {
  return result.image.colour[static_cast<std::size_t>(y * result.image.width + x)];
}
inline float depth(const Result& result, int x, int y) {
  return result.image.depth[static_cast<std::size_t>(y * result.image.width + x)];
}

}  // namespace delray::raytrace
