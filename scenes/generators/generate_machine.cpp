// A table of gears that turn, with pistons that they drive and lamps that jump: a thousand
// instances of four models, each moved by key frames of one of the interpolations. Gear k of the
// grid turns once every kGearPeriod seconds, its neighbours the other way.
#include <algorithm>
#include <cmath>

#include "scenes/generators/generators.h"
#include "scenes/generators/key_frames.h"
#include "scenes/generators/shapes.h"
#include "scenes/geometry/normals.h"
#include "scenes/pose.h"

namespace delray::scenes::internal {
namespace {

constexpr double kGearPeriod = 4.0;      // seconds
constexpr std::uint64_t kGridSide = 16;  // of the grid of gears, at most
constexpr double kGearPitch = 2.4;       // from one gear to the next
constexpr double kPistonStroke = 0.45;   // of a piston, to either side
constexpr std::uint32_t kTeeth = 12;
constexpr int kKeysOfATurn = 8;            // of a turn
constexpr std::uint64_t kLeastPart = 400;  // triangles
enum : std::uint32_t { kPlate, kGear, kPin, kPiston, kLamp };

// A gear of radius 1 around y: its rim goes in and out, and both faces have a rim and a hub.
Mesh make_gear(std::uint32_t segments) {
  Mesh mesh;
  mesh.name = "gear";
  mesh.material = kGear;
  const std::uint32_t columns = segments * kTeeth;
  constexpr float kRing[][2] = {{0.25F, 0.14F}, {0.7F, 0.14F},  {1, 0.1F},
                                {1, -0.1F},     {0.7F, -0.14F}, {0.25F, -0.14F}};
  for (const auto& [radius, height] : kRing) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const glm::dvec2 at = turn(static_cast<double>(i) / columns);
      const bool tooth = i % segments * 2 < segments;
      const float r = radius < 1 ? radius : (tooth ? 1.0F : 0.82F);
      mesh.positions.emplace_back(r * at.x, height, -r * at.y);
    }
  }
  append_grid_triangles(mesh, columns, 6, true, true);
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  return mesh;
}

// A rod of radius `radius` along y from 0 to `height`.
Mesh make_rod(const char* name, std::uint32_t material, std::uint32_t columns, float radius,
              float height) {
  Mesh mesh;
  mesh.name = name;
  mesh.material = material;
  const float rows[][2] = {{0, 0}, {radius, 0}, {radius, height}, {0, height}};
  for (const auto& [r, y] : rows) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const glm::dvec2 at = turn(static_cast<double>(i) / columns);
      mesh.positions.emplace_back(r * at.x, y, -r * at.y);
    }
  }
  append_grid_triangles(mesh, columns, 4, true, false);
  // The first and last row are one point each.
  std::erase_if(mesh.triangles, [&](const glm::uvec3& t) {
    const glm::vec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
    return a == b || b == c || c == a;
  });
  return mesh;
}

AnimationChannel turning(std::uint32_t node, double direction) {
  AnimationChannel channel = channel_of(node, AnimationChannel::Path::rotation,
                                        AnimationChannel::Interpolation::linear, 4);
  for (int k = 0; k <= kKeysOfATurn; ++k) {
    const double part = static_cast<double>(k) / kKeysOfATurn;
    const glm::dvec4 q = rotation_by({0, 1, 0}, direction * part);
    append(channel.times, {kGearPeriod * part});
    append(channel.values, {q.x, q.y, q.z, q.w});
  }
  return channel;
}

// x = x0 + stroke * cos(turn), with the derivatives at the keys.
AnimationChannel sliding(std::uint32_t node, const glm::dvec3& middle) {
  AnimationChannel channel = channel_of(node, AnimationChannel::Path::translation,
                                        AnimationChannel::Interpolation::cubic_spline, 3);
  constexpr double kTurn = 2 * 3.14159265358979323846 / kGearPeriod;
  for (int k = 0; k <= kKeysOfATurn; ++k) {
    const double part = static_cast<double>(k) / kKeysOfATurn;
    const glm::dvec2 at = turn(part);
    const double slope = -kPistonStroke * kTurn * at.y;
    append(channel.times, {kGearPeriod * part});
    append(channel.values,
           {slope, 0, 0, middle.x + kPistonStroke * at.x, middle.y, middle.z, slope, 0, 0});
  }
  return channel;
}

AnimationChannel jumping(std::uint32_t node, const glm::dvec3& low, std::uint64_t phase) {
  AnimationChannel channel = channel_of(node, AnimationChannel::Path::translation,
                                        AnimationChannel::Interpolation::step, 3);
  for (std::uint64_t k = 0; k <= 4; ++k) {
    append(channel.times, {kGearPeriod * static_cast<double>(k) / 4});
    append(channel.values, {low.x, low.y + ((k + phase) % 2 == 0 ? 0.0 : 0.25), low.z});
  }
  return channel;
}

}  // namespace

Scene generate_machine(std::uint64_t triangles, std::uint64_t /*seed*/) {
  const auto side = static_cast<std::uint64_t>(
      std::clamp(std::floor(std::sqrt(static_cast<double>(triangles) / (4.0 * kLeastPart))), 1.0,
                 static_cast<double>(kGridSide)));
  // Of each group of four models.
  const double budget = static_cast<double>(triangles) / static_cast<double>(side * side);
  const auto segments =
      static_cast<std::uint32_t>(std::max(2.0, std::floor(0.5 * budget / (12.0 * kTeeth) + 0.5)));
  const double left = std::max(0.0, budget - 12.0 * kTeeth * segments);
  const auto rod = static_cast<std::uint32_t>(std::max(6.0, std::floor(0.25 * left / 4)));
  const auto ball = static_cast<std::uint32_t>(
      std::max(1.0, std::floor(std::sqrt(std::max(0.0, left - 8.0 * rod) / 8.0) + 0.5)));

  Scene scene;
  scene.materials = {
      matte("plate", {0.34F, 0.36F, 0.38F}, 0.7F), matte("gear", {0.55F, 0.40F, 0.20F}, 0.35F),
      matte("pin", {0.65F, 0.66F, 0.68F}, 0.3F), matte("piston", {0.20F, 0.33F, 0.52F}, 0.5F),
      matte("lamp", {0.80F, 0.25F, 0.16F}, 0.4F)};
  scene.materials[kGear].metallic = 0.6F;
  scene.meshes = {make_gear(segments), make_rod("pin", kPin, rod, 0.1F, 0.35F),
                  make_rod("piston", kPiston, rod, 0.22F, 0.55F), make_sphere(ball)};
  scene.meshes[3].name = "lamp";
  scene.meshes[3].material = kLamp;
  for (std::uint32_t i = 0; i < 3; ++i) compute_normals(scene.meshes[i], 0.5F);

  Animations& table = scene.animations;
  Animation& run = table.animations.emplace_back();
  run.name = "run";
  const auto add = [&](std::uint32_t mesh, std::uint32_t parent, const glm::dvec3& at,
                       double size) {
    const auto node = static_cast<std::uint32_t>(table.nodes.size());
    table.nodes.push_back({parent, scene.meshes[mesh].name, at});
    table.nodes.back().scale = glm::dvec3(size);
    table.instances.push_back({static_cast<std::uint32_t>(scene.instances.size()), node});
    scene.instances.push_back({mesh});
    return node;
  };
  const double middle = 0.5 * kGearPitch * static_cast<double>(side - 1);
  for (std::uint64_t i = 0; i < side * side; ++i) {
    const double x = kGearPitch * static_cast<double>(i % side) - middle;
    const double z =
        kGearPitch * std::floor(static_cast<double>(i) / static_cast<double>(side)) - middle;
    const double direction = (i % side + i / side) % 2 == 0 ? 1 : -1;
    const std::uint32_t gear = add(0, kNone, {x, 0.2, z}, 1);
    run.channels.push_back(turning(gear, direction));
    add(1, gear, {0.62, 0.1, 0}, 1);
    const glm::dvec3 piston(x, 0, z + 0.5 * kGearPitch);
    run.channels.push_back(
        sliding(add(2, kNone, piston + glm::dvec3(kPistonStroke, 0, 0), 1), piston));
    const glm::dvec3 lamp(x + 0.5 * kGearPitch, 0.3, z + 0.5 * kGearPitch);
    const std::uint64_t phase = (i % side + i / side) % 2;
    run.channels.push_back(
        jumping(add(3, kNone, lamp + glm::dvec3(0, phase == 0 ? 0 : 0.25, 0), 0.16), lamp, phase));
  }
  const auto half = static_cast<float>(middle + kGearPitch);
  Mesh plate;
  plate.name = "plate";
  append_quad(plate, {-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half}, 4);
  add_mesh(scene, std::move(plate));

  Light key;
  key.colour = glm::vec3(1.0F, 0.96F, 0.90F) * 2.4F;
  key.direction = glm::normalize(glm::vec3(0.5F, -0.8F, -0.4F));
  scene.lights = {key};
  scene.environment.zenith = {0.30F, 0.36F, 0.44F};
  scene.environment.horizon = {0.45F, 0.46F, 0.47F};
  scene.environment.ground = {0.12F, 0.11F, 0.10F};
  Camera camera;
  camera.eye = glm::vec3(0.25F, 0.75F, 1.0F) * (1.9F * half);
  camera.at = glm::vec3(0, -0.1F * half, 0);
  camera.vertical_fov = 45.0F;
  scene.cameras.push_back(camera);
  pose(scene, {});
  return scene;
}

}  // namespace delray::scenes::internal
