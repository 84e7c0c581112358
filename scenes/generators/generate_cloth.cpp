// A flag in the wind: a wave z = a x cos(k x - w t) runs along it from the pole. It is the sum of
// two morph targets, a x cos(k x) and a x sin(k x), with weights cos(w t) and sin(w t), so that the
// pose is the formula's wherever the weights are, which cubic splines follow to some 1e-3.
#include <algorithm>
#include <cmath>

#include "scenes/animation/deform.h"
#include "scenes/generators/generators.h"
#include "scenes/generators/key_frames.h"
#include "scenes/generators/shapes.h"
#include "scenes/geometry/order.h"
#include "scenes/pose.h"

namespace delray::scenes::internal {
namespace {

constexpr float kFlagWidth = 3.0F, kFlagHeight = 2.0F;
constexpr double kWaveSlope = 0.12;  // a: of the wave's height along the flag
constexpr double kWavesAlong = 2.0;  // along the flag
constexpr double kWavePeriod = 2.0;  // seconds
constexpr int kKeysOfAWave = 16;     // of a period

Mesh make_flag(std::uint32_t columns, std::uint32_t rows) {
  Mesh mesh;
  mesh.name = "flag";
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(columns);
      const float t = static_cast<float>(j) / static_cast<float>(rows);
      mesh.positions.emplace_back(s * kFlagWidth, t * kFlagHeight, 0.0F);
      const bool cross = std::abs(s - 0.36F) < 0.07F || std::abs(t - 0.5F) < 0.105F;
      mesh.colours.emplace_back(
          cross ? glm::vec3(0.85F, 0.80F, 0.70F) : glm::vec3(0.55F, 0.06F, 0.07F), 1.0F);
    }
  }
  append_grid_triangles(mesh, columns + 1, rows + 1, false, false);
  order_for_locality(mesh);
  return mesh;
}

Deformation waves_of(const Mesh& mesh) {
  Deformation deformation;
  deformation.targets.resize(2);
  for (const glm::vec3& p : mesh.positions) {
    const glm::dvec2 phase = turn(kWavesAlong * double{p.x} / double{kFlagWidth});
    const double height = kWaveSlope * double{p.x};
    deformation.targets[0].positions.emplace_back(0, 0, height * phase.x);
    deformation.targets[1].positions.emplace_back(0, 0, height * phase.y);
  }
  return deformation;
}

AnimationChannel waving(std::uint32_t node) {
  AnimationChannel channel = channel_of(node, AnimationChannel::Path::weights,
                                        AnimationChannel::Interpolation::cubic_spline, 2);
  constexpr double kWaveTurn = 2 * 3.14159265358979323846 / kWavePeriod;
  for (int k = 0; k <= kKeysOfAWave; ++k) {
    const double part = static_cast<double>(k) / kKeysOfAWave;
    const glm::dvec2 at = turn(part);
    append(channel.times, {kWavePeriod * part});
    append(channel.values,
           {-kWaveTurn * at.y, kWaveTurn * at.x, at.x, at.y, -kWaveTurn * at.y, kWaveTurn * at.x});
  }
  return channel;
}

}  // namespace

Scene generate_cloth(std::uint64_t triangles, std::uint64_t /*seed*/) {
  Scene scene;
  scene.materials = {matte("cloth", glm::vec3(1.0F), 0.9F), matte("pole", {0.4F, 0.3F, 0.2F}),
                     matte("ground", {0.20F, 0.24F, 0.12F}, 0.95F)};
  const double cells = std::max(2.0, 0.5 * static_cast<double>(triangles));
  const auto rows = static_cast<std::uint32_t>(
      std::max(1.0, std::floor(std::sqrt(cells * double{kFlagHeight} / double{kFlagWidth}) + 0.5)));
  const auto columns =
      static_cast<std::uint32_t>(std::max(2.0, std::floor(cells / static_cast<double>(rows))));
  Mesh flag = make_flag(columns, rows);
  Deformation waves = waves_of(flag);
  DeformedMesh deformed = make_deformed(flag, std::move(waves), {});
  deformed.moves = true;
  Animations& table = scene.animations;
  table.nodes.push_back({kNone, "flag", {0, 2, 0}});
  table.nodes.back().weights = {1, 0};
  table.meshes.push_back(std::move(deformed));
  table.animations.push_back({"wave", {waving(0)}});
  const glm::mat4x3 above(glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1),
                          glm::vec3(0, 2, 0));
  add_mesh(scene, std::move(flag), above);

  Mesh pole;
  pole.name = "pole";
  pole.material = 1;
  append_quad(pole, {-0.06F, 0, 0.06F}, {0.06F, 0, 0}, {0, 4.2F, 0});
  append_quad(pole, {0, 0, 0.06F}, {0, 0, -0.12F}, {0, 4.2F, 0});
  append_quad(pole, {-0.06F, 0, -0.06F}, {0, 0, 0.12F}, {0, 4.2F, 0});
  append_quad(pole, {0, 0, -0.06F}, {-0.06F, 0, 0}, {0, 4.2F, 0});
  add_mesh(scene, std::move(pole));
  Mesh ground;
  ground.name = "ground";
  ground.material = 2;
  append_quad(ground, {-8, 0, 8}, {16, 0, 0}, {0, 0, -16}, 4);
  add_mesh(scene, std::move(ground));

  Light sun;
  sun.colour = glm::vec3(1.0F, 0.95F, 0.86F) * 2.6F;
  sun.direction = glm::normalize(glm::vec3(0.5F, -0.6F, -0.7F));
  scene.lights = {sun};
  scene.environment.zenith = {0.22F, 0.36F, 0.62F};
  scene.environment.horizon = {0.60F, 0.65F, 0.70F};
  scene.environment.ground = {0.13F, 0.13F, 0.10F};
  Camera camera;
  camera.eye = {2.6F, 2.6F, 6.6F};
  camera.at = {1.35F, 2.2F, 0.0F};
  camera.vertical_fov = 40.0F;
  scene.cameras.push_back(camera);
  pose(scene, {});
  return scene;
}

}  // namespace delray::scenes::internal
