// An arm that bends: a tube skinned to a chain of joints, each turned about z by the same angle, so
// that the joints lie on a circle. A vertex between two joints follows both.
#include <algorithm>
#include <cmath>

#include "scenes/animation/deform.h"
#include "scenes/generators/generators.h"
#include "scenes/generators/key_frames.h"
#include "scenes/generators/shapes.h"
#include "scenes/pose.h"

namespace delray::scenes::internal {
namespace {

constexpr std::uint32_t kArmJoints = 8;
constexpr double kArmLength = 0.5;   // from joint to joint
constexpr double kArmRadius = 0.28;  // at the foot; half of it at the tip
constexpr double kArmBend = 0.055;   // of a turn, at each joint, at most
constexpr double kArmPeriod = 4.0;   // seconds
constexpr int kKeysOfABend = 16;

Mesh make_tube(std::uint32_t columns, std::uint32_t rows) {
  Mesh mesh;
  mesh.name = "arm";
  for (std::uint32_t j = 0; j <= rows; ++j) {
    const double part = static_cast<double>(j) / rows;
    const double radius = j == rows ? 0.0 : kArmRadius * (1 - 0.5 * part);
    for (std::uint32_t i = 0; i < columns; ++i) {
      const glm::dvec2 at = turn(static_cast<double>(i) / columns);
      mesh.positions.emplace_back(radius * at.x, kArmJoints * kArmLength * part, -radius * at.y);
      const glm::dvec3 normal = j == rows ? glm::dvec3(0, 1, 0) : glm::dvec3(at.x, 0.06, -at.y);
      mesh.normals.emplace_back(glm::normalize(normal));
    }
  }
  append_grid_triangles(mesh, columns, rows + 1, true, false);
  std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
    const glm::vec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
    return a == b || b == c || c == a;
  });
  return mesh;
}

Deformation skin_of(const Mesh& mesh) {
  Deformation deformation;
  deformation.influences = 4;
  for (const glm::vec3& p : mesh.positions) {
    const double along = std::clamp(double{p.y} / kArmLength - 0.5, 0.0, double{kArmJoints - 1});
    const auto first = std::min(static_cast<std::uint32_t>(along), kArmJoints - 2);
    const auto second = static_cast<float>(along - first);
    for (const std::uint32_t joint : {first, first + 1, 0U, 0U})
      deformation.joints.push_back(static_cast<std::uint16_t>(joint));
    for (const float weight : {1 - second, second, 0.0F, 0.0F})
      deformation.weights.push_back(weight);
  }
  return deformation;
}

// By kArmBend * sin(turn); the derivative of a quaternion about one axis is that of its numbers.
AnimationChannel bending(std::uint32_t node) {
  AnimationChannel channel = channel_of(node, AnimationChannel::Path::rotation,
                                        AnimationChannel::Interpolation::cubic_spline, 4);
  constexpr double kPi = 3.14159265358979323846;
  for (int k = 0; k <= kKeysOfABend; ++k) {
    const double part = static_cast<double>(k) / kKeysOfABend;
    const glm::dvec2 at = turn(part);
    const glm::dvec4 q = rotation_by({0, 0, 1}, kArmBend * at.y);
    const double slope = kPi * kArmBend * at.x * 2 * kPi / kArmPeriod;  // of half the angle
    append(channel.times, {kArmPeriod * part});
    append(channel.values, {0, 0, q.w * slope, -q.z * slope});
    append(channel.values, {q.x, q.y, q.z, q.w});
    append(channel.values, {0, 0, q.w * slope, -q.z * slope});
  }
  return channel;
}

}  // namespace

Scene generate_arm(std::uint64_t triangles, std::uint64_t /*seed*/) {
  Scene scene;
  scene.materials = {matte("arm", {0.62F, 0.30F, 0.24F}, 0.5F),
                     matte("ground", {0.40F, 0.42F, 0.44F}, 0.8F)};
  const double cells = std::max(24.0, 0.5 * static_cast<double>(triangles));
  const auto columns =
      static_cast<std::uint32_t>(std::max(4.0, std::floor(std::sqrt(cells / 3.0) + 0.5)));
  const auto rows =
      static_cast<std::uint32_t>(std::max(6.0, std::floor(cells / static_cast<double>(columns))));
  Mesh tube = make_tube(columns, rows);
  Deformation deformation = skin_of(tube);
  DeformedMesh deformed = make_deformed(tube, std::move(deformation), {});
  deformed.moves = true;
  deformed.skin = 0;
  Animations& table = scene.animations;
  table.nodes.push_back({kNone, "arm"});
  table.meshes.push_back(std::move(deformed));
  Skin skin;
  Animation bend{"bend", {}};
  for (std::uint32_t j = 0; j < kArmJoints; ++j) {
    const std::uint32_t node = j + 1;
    table.nodes.push_back(
        {j == 0 ? kNone : j, "joint " + std::to_string(j), {0, j == 0 ? 0 : kArmLength, 0}});
    skin.joints.push_back(node);
    glm::dmat4 to_joint(1.0);
    to_joint[3].y = -kArmLength * j;
    skin.to_joint.push_back(to_joint);
    if (j > 0) bend.channels.push_back(bending(node));
  }
  table.skins.push_back(std::move(skin));
  table.animations.push_back(std::move(bend));
  add_mesh(scene, std::move(tube));

  Mesh ground;
  ground.name = "ground";
  ground.material = 1;
  append_quad(ground, {-6, 0, 6}, {12, 0, 0}, {0, 0, -12}, 4);
  add_mesh(scene, std::move(ground));
  Light key;
  key.colour = glm::vec3(1.0F, 0.96F, 0.90F) * 2.4F;
  key.direction = glm::normalize(glm::vec3(0.5F, -0.8F, -0.6F));
  scene.lights = {key};
  scene.environment.zenith = {0.30F, 0.36F, 0.44F};
  scene.environment.horizon = {0.50F, 0.51F, 0.52F};
  scene.environment.ground = {0.12F, 0.11F, 0.10F};
  Camera camera;
  camera.eye = {0.0F, 2.6F, 8.5F};
  camera.at = {0.0F, 1.7F, 0.0F};
  camera.vertical_fov = 40.0F;
  scene.cameras.push_back(camera);
  pose(scene, {});
  return scene;
}

}  // namespace delray::scenes::internal
