// Poses as formulas give them, from key frames of all interpolations.
#include "scenes/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "scenes/animation/interpolate.h"
#include "scenes/generate.h"

namespace delray::scenes {
namespace {

using Path = AnimationChannel::Path;
using Interpolation = AnimationChannel::Interpolation;
constexpr double kTurn = 2 * std::numbers::pi;

double value_at(const AnimationChannel& channel, double seconds) {
  double value = 0;
  internal::interpolate(channel, seconds, {&value, 1});
  return value;
}

TEST(Interpolate, StepsLinesAndSplines) {
  AnimationChannel channel{Path::weights, Interpolation::step, 0, 1, {1, 2, 4}, {10, 20, 0}};
  for (const auto& [seconds, value] :
       {std::pair{0.0, 10.0}, {1.0, 10.0}, {1.99, 10.0}, {2.0, 20.0}, {3.9, 20.0}, {9.0, 0.0}})
    EXPECT_EQ(value_at(channel, seconds), value) << seconds;
  channel.interpolation = Interpolation::linear;
  for (const auto& [seconds, value] :
       {std::pair{0.0, 10.0}, {1.25, 12.5}, {2.0, 20.0}, {3.0, 10.0}, {4.0, 0.0}, {5.0, 0.0}})
    EXPECT_EQ(value_at(channel, seconds), value) << seconds;
  // Hermite's: of tangents 0 half way in value, with slopes 4 / s and -4 / s a further 4 * 2 / 4.
  channel = {Path::weights, Interpolation::cubic_spline, 0, 1, {0, 2}, {7, 0, 0, 0, 8, 9}};
  EXPECT_EQ(value_at(channel, 1), 4);
  channel.values = {7, 0, 4, -4, 8, 9};
  EXPECT_EQ(value_at(channel, 1), 6);
  EXPECT_EQ(value_at(channel, 0), 0);
  EXPECT_EQ(value_at(channel, 2), 8);
}

TEST(Interpolate, RotationsTakeTheShorterArcAtAnEvenPace) {
  const auto half = static_cast<float>(std::sqrt(0.5));
  // By 0 and, with the sign that looks like the longer way, by a quarter turn about z.
  const AnimationChannel channel{Path::rotation, Interpolation::linear,           0, 4,
                                 {0, 1},         {0, 0, 0, 1, 0, 0, -half, -half}};
  for (const double s : {0.0, 0.25, 0.5, 1.0}) {
    double q[4];
    internal::interpolate(channel, s, q);
    const double angle = s * kTurn / 8;
    // The opposite quaternion is the same rotation.
    const double sign = q[3] < 0 ? -1 : 1;
    EXPECT_NEAR(sign * q[2], std::sin(angle), 1e-7) << s;
    EXPECT_NEAR(sign * q[3], std::cos(angle), 1e-7) << s;
  }
}

Scene at(const char* name, double seconds) {
  Scene scene = generate(name);
  pose(scene, {0, seconds});
  return scene;
}

TEST(Pose, GearsTurnPistonsSlideAndLampsJump) {
  for (const double t : {0.0, 0.5, 0.77, 1.3, 3.9}) {
    const Scene scene = at("gen:machine:6400", t);
    ASSERT_EQ(scene.animations.instances.size(), 16U);
    for (std::size_t unit = 0; unit < 4; ++unit) {
      const glm::dmat4x3 gear(scene.instances[4 * unit].transform),
          pin(scene.instances[4 * unit + 1].transform);
      const double sign = unit == 1 || unit == 2 ? -1 : 1, angle = sign * kTurn * t / 4;
      const glm::dvec3 x_axis(std::cos(angle), 0, -std::sin(angle));
      EXPECT_LT(glm::distance(gear[0], x_axis), 1e-6) << t;
      EXPECT_LT(glm::distance(pin[3], gear[3] + x_axis * 0.62 + glm::dvec3(0, 0.1, 0)), 1e-6);
      const glm::dvec3 piston(scene.instances[4 * unit + 2].transform[3]);
      // A spline through 8 keys of a turn: (2 pi / 8)^4 / 384 of the stroke off, at most.
      EXPECT_NEAR(piston.x, gear[3].x + 0.45 * std::cos(kTurn * t / 4), 5e-4) << t;
      const bool is_high = (static_cast<int>(t) + (sign < 0 ? 1 : 0)) % 2 != 0;
      EXPECT_NEAR(scene.instances[4 * unit + 3].transform[3].y, is_high ? 0.55 : 0.3, 1e-6) << t;
    }
  }
}

TEST(Pose, AFlagIsAWave) {
  for (const double t : {0.0, 0.25, 0.4, 1.7}) {
    const Scene scene = at("gen:cloth:800", t);
    const DeformedMesh& flag = scene.animations.meshes.at(0);
    const Mesh& mesh = scene.meshes[flag.mesh];
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const double x = flag.positions[i].x;
      const double z = 0.12 * x * std::cos(kTurn * (2 * x / 3 - t / 2));
      EXPECT_NEAR(mesh.positions[i].z, z, 1e-4) << t;
      EXPECT_EQ(mesh.positions[i].y, flag.positions[i].y);
      const double slope = 0.12 * std::cos(kTurn * (2 * x / 3 - t / 2)) -
                           0.12 * x * std::sin(kTurn * (2 * x / 3 - t / 2)) * kTurn * 2 / 3;
      const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope, 0, 1));
      if (x > 0.2 && x < 2.8) {
        EXPECT_GT(std::abs(glm::dot(glm::dvec3(mesh.normals[i]), normal)), 0.99) << x;
      }
    }
  }
}

TEST(Pose, JointsLieOnACircle) {
  for (const double t : {0.0, 0.75, 1.0, 2.6}) {
    const Scene scene = at("gen:arm:2000", t);
    const DeformedMesh& arm = scene.animations.meshes.at(0);
    const double bend = kTurn * 0.055 * std::sin(kTurn * t / 4);
    // A spline through 16 keys is (2 pi / 16)^4 / 384 of the largest angle off, at each of seven
    // joints, which are up to 3.5 away.
    constexpr double kAngle = kTurn * 0.055 * 6.2e-5, kPlace = 14 * kAngle + 1e-5;
    // The frame of the last joint: every joint but the first turns.
    glm::dvec3 joint(0);
    for (int j = 0; j < 7; ++j)
      joint += 0.5 * glm::dvec3(-std::sin(j * bend), std::cos(j * bend), 0);
    const glm::dvec3 along(-std::sin(7 * bend), std::cos(7 * bend), 0),
        across(std::cos(7 * bend), std::sin(7 * bend), 0);
    std::size_t looked_at = 0;
    for (std::size_t i = 0; i < arm.positions.size(); ++i) {
      const glm::dvec3 p(arm.positions[i]), n(arm.normals[i]);
      if (p.y < 7.5 * 0.5) continue;  // follows others, too
      const glm::dvec3 wanted = joint + along * (p.y - 3.5) + across * p.x + glm::dvec3(0, 0, p.z);
      const Mesh& mesh = scene.meshes[arm.mesh];
      EXPECT_LT(glm::distance(glm::dvec3(mesh.positions[i]), wanted), kPlace) << t;
      const glm::dvec3 normal = along * n.y + across * n.x + glm::dvec3(0, 0, n.z);
      EXPECT_LT(glm::distance(glm::dvec3(mesh.normals[i]), normal), 7 * kAngle + 1e-6) << t;
      ++looked_at;
    }
    EXPECT_GT(looked_at, 10U);
  }
}

TEST(Pose, TellsWhatHasChangedAndNothingElse) {
  Scene machine = generate("gen:machine:6400"), cloth = generate("gen:cloth:200");
  EXPECT_TRUE(pose(machine, {}).empty());
  EXPECT_EQ(pose(machine, {0, 0.5}).instances.size(), 12U);  // lamps wait for the next second
  EXPECT_TRUE(pose(machine, {0, 0.5}).empty());
  EXPECT_EQ(pose(machine, {0, 1.5}).instances.size(), 16U);
  EXPECT_TRUE(pose(cloth, {0, 2}).empty());  // a whole period
  EXPECT_EQ(pose(cloth, {0, 0.3}).meshes, std::vector<std::uint32_t>{0});
  EXPECT_EQ(pose(cloth, {}).meshes.size(), 1U);
  EXPECT_EQ(mesh_motions(cloth),
            (std::vector{MeshMotion::deforming, MeshMotion::still, MeshMotion::still}));
  EXPECT_EQ(mesh_motions(machine)[0], MeshMotion::rigid);
  EXPECT_EQ(mesh_motions(machine).back(), MeshMotion::still);
}

TEST(Pose, RefusesCoordinatesThatAreTooLarge) {
  Scene cloth = generate("gen:cloth:200"), machine = generate("gen:machine:1600");
  for (float& value : cloth.animations.animations[0].channels[0].values) value = 1e30F;
  EXPECT_THROW(pose(cloth, {0, 1}), std::range_error);
  machine.animations.nodes[0].scale.x = 1e30;
  EXPECT_THROW(pose(machine, {}), std::range_error);
}

TEST(Pose, AnimationsByNameAndNumber) {
  Scene scene = generate("gen:cloth:200");
  scene.animations.animations.push_back({"0", {}});
  EXPECT_EQ(find_animation(scene, "wave"), 0U);
  EXPECT_EQ(find_animation(scene, "0"), 1U);
  EXPECT_EQ(find_animation(scene, "1"), 1U);
  EXPECT_FALSE(find_animation(scene, "2"));
  EXPECT_FALSE(find_animation(scene, "walk"));
}

}  // namespace
}  // namespace delray::scenes
