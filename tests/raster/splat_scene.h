// Points and segments of every kind among triangles.
#pragma once

#include "tests/raster/random_scene.h"

namespace delray::raster {

inline void add_point(scenes::Mesh& mesh, const glm::vec3& p) {
  const auto i = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back(p);
  mesh.triangles.emplace_back(i, i, i);
}

// One mesh for each kind of shape and unit of its radius: some with normals, some with colours, lit
// and unlit, placed twice, some points before the near plane or behind the eye, some twice at one
// place, and some large.
inline scenes::Scene splat_scene(unsigned seed, bool with_triangles = true, int points = 300) {
  using Kind = scenes::Shape::Kind;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1), both(-1, 1);
  scenes::Scene scene = random_scene(seed, with_triangles ? 10 : 1);
  if (!with_triangles) {
    scene.meshes.clear();
    scene.instances.clear();
  }
  const auto material = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.resize(material + 2);
  scene.materials[material].unlit = true;
  int number = 0;
  for (const Kind kind : {Kind::point, Kind::disc, Kind::sphere, Kind::line}) {
    for (const bool in_pixels : {true, false}) {
      for (const bool large : {false, true}) {
        scenes::Mesh mesh;
        mesh.shape = {kind, in_pixels,
                      in_pixels ? (large ? 25.0F : 3.0F * unit(random)) : (large ? 0.4F : 0.03F)};
        mesh.material = material + static_cast<std::uint32_t>(number % 2);
        const int count = large ? 4 : points;
        for (int i = 0; i < count; ++i) {
          const glm::vec3 p(both(random), both(random), 1.6F * both(random) + 1.5F);
          const auto at = static_cast<std::uint32_t>(mesh.positions.size());
          const bool again = i % 9 == 8;
          mesh.positions.push_back(again ? mesh.positions[at - 1] : p);
          if (kind == Kind::line) {
            mesh.positions.push_back(
                i % 7 == 0 ? mesh.positions[at]
                           : p + 0.4F * glm::vec3(both(random), both(random), both(random)));
            mesh.triangles.emplace_back(at, at + 1, at + 1);
          } else {
            mesh.triangles.emplace_back(at, at, at);
          }
        }
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
          if (number % 3 != 0)
            mesh.normals.push_back(i % 10 == 0
                                       ? glm::vec3(0.0F)
                                       : glm::normalize(glm::vec3(both(random), both(random), 1)));
          if (number % 4 != 1)
            mesh.colours.emplace_back(unit(random), unit(random), unit(random), unit(random));
        }
        glm::mat4x3 turned(1.0F);
        turned[0] = {0, 0.5F, 0};
        turned[1] = {-0.5F, 0, 0};
        turned[2] = {0, 0, 0.5F};
        scene.instances.push_back({static_cast<std::uint32_t>(scene.meshes.size())});
        if (number % 2 == 0)
          scene.instances.push_back({static_cast<std::uint32_t>(scene.meshes.size()), turned});
        scene.meshes.push_back(std::move(mesh));
        ++number;
      }
    }
  }
  return scene;
}

}  // namespace delray::raster
