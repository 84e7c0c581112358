// Instances of four models on a jittered grid: a rock displaced by noise, a fluted column, a tube
// around a trefoil knot and a tree of single-triangle leaves. The number of instances grows with
// the triangles up to its limit, then their detail. O(triangles of the models).
#include <algorithm>
#include <cmath>

#include "parallel/parallel_for.h"
#include "scenes/generators/generators.h"
#include "scenes/generators/shapes.h"
#include "scenes/geometry/noise.h"
#include "scenes/geometry/normals.h"

namespace delray::scenes::internal {
namespace {

constexpr std::uint32_t kColumns = 28, kRows = 36;  // of instances: 1008
constexpr std::uint64_t kLeastModel = 1000;         // triangles below which a model has no shape
constexpr float kSpacing = 3.0F;                    // of instances; models are about 2 wide
constexpr std::uint32_t kModels = 4;

// columns x rows cells of two triangles, about `triangles` of them, `ratio` times as many columns.
glm::uvec2 grid_of(std::uint64_t triangles, double ratio) {
  const double cells = static_cast<double>(triangles) / 2;
  const double columns = std::max(4.0, std::round(std::sqrt(cells * ratio)));
  const double rows = std::max(2.0, std::round(cells / columns));
  return {static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows)};
}

glm::vec3 turned(float radius, float y, double turns) {
  const glm::dvec2 direction = turn(turns);
  return {radius * static_cast<float>(direction.x), y, radius * static_cast<float>(direction.y)};
}

// A sphere whose surface is moved in and out by noise.
Mesh make_rock(std::uint64_t triangles, std::uint64_t seed) {
  const double n = std::sqrt(static_cast<double>(triangles) / 8);
  Mesh mesh = make_sphere(static_cast<std::uint32_t>(std::max(2L, std::lround(n))));
  mesh.name = "rock";
  mesh.colours.resize(mesh.positions.size());
  parallel::parallel_for(0, mesh.positions.size(), 256, [&](std::size_t i) {
    glm::vec3& p = mesh.positions[i];
    float sum = 0, amplitude = 0.5F, frequency = 1.4F;
    for (std::uint64_t octave = 0; octave < 7; ++octave) {
      sum += amplitude * std::abs(noise(seed + octave, p * frequency).value);
      amplitude *= 0.5F;
      frequency *= 2.1F;
    }
    p *= glm::vec3(1.1F, 0.85F, 1.0F) * (0.62F + sum);
    p.y += 0.55F;
    mesh.colours[i] = glm::vec4(
        glm::mix(glm::vec3(0.16F, 0.15F, 0.13F), glm::vec3(0.50F, 0.46F, 0.40F), 1.6F * sum), 1.0F);
  });
  return mesh;
}

// A fluted column with a base and a capital: a turned profile.
Mesh make_column(std::uint64_t triangles) {
  const glm::uvec2 n = grid_of(triangles, 1.0);
  Mesh mesh;
  mesh.name = "column";
  for (std::uint32_t j = 0; j <= n.y; ++j) {
    const float t = static_cast<float>(j) / static_cast<float>(n.y);
    const float y = 3.4F * t;
    const float ends = std::max(0.0F, std::abs(t - 0.5F) * 2.0F - 0.86F) / 0.14F;
    const float steps = ends > 0.66F ? 0.30F : ends > 0.3F ? 0.20F : 0.08F * ends;
    for (std::uint32_t i = 0; i < n.x; ++i) {
      const double u = static_cast<double>(i) / n.x;
      const auto flute = static_cast<float>(std::max(0.0, turn(u * 20).x));
      const float depth = ends > 0.3F ? 0.0F : 0.045F * flute;
      mesh.positions.push_back(turned(0.46F - 0.08F * t + steps - depth, y, -u));
      mesh.colours.emplace_back(glm::vec3(0.72F, 0.68F, 0.60F) * (1.0F - 4.0F * depth), 1.0F);
    }
  }
  append_grid_triangles(mesh, n.x, n.y + 1, true, false);
  return mesh;
}

// A tube around a trefoil knot, standing on the ground, with a rope's surface.
Mesh make_knot(std::uint64_t triangles) {
  const glm::uvec2 n = grid_of(triangles, 12.0);
  const auto centre = [](double t) {
    const glm::dvec2 a = turn(t), b = turn(2 * t), c = turn(3 * t);
    return glm::dvec3(a.y + 2 * b.y, a.x - 2 * b.x, -c.y) * 0.36;
  };
  Mesh mesh;
  mesh.name = "knot";
  mesh.positions.resize(std::size_t{n.x} * std::max(n.y, 4U));
  const std::uint32_t around = std::max(n.y, 4U);
  for (std::uint32_t i = 0; i < n.x; ++i) {
    const double t = static_cast<double>(i) / n.x;
    const glm::dvec3 along = glm::normalize(centre(t + 1e-4) - centre(t - 1e-4));
    const glm::dvec3 side = glm::normalize(glm::cross(along, glm::dvec3(0, 0, 1)));
    const glm::dvec3 out = glm::cross(side, along);
    for (std::uint32_t j = 0; j < around; ++j) {
      const double u = static_cast<double>(j) / around;
      const glm::dvec2 direction = turn(u);
      const double radius = 0.24 + 0.035 * turn(3 * u + 40 * t).x;
      const glm::dvec3 p = centre(t) + (side * direction.x + out * direction.y) * radius;
      mesh.positions[std::size_t{j} * n.x + i] = p + glm::dvec3(0, 1.35, 0);
    }
  }
  mesh.colours.assign(mesh.positions.size(), glm::vec4(0.55F, 0.13F, 0.06F, 1.0F));
  append_grid_triangles(mesh, n.x, around, true, true);
  return mesh;
}

// A trunk and a crown of rough leaves in clumps.
Mesh make_tree(std::uint64_t triangles, std::uint64_t seed) {
  Mesh mesh;
  mesh.name = "tree";
  const glm::uvec2 n = grid_of(triangles / 10, 0.5);
  for (std::uint32_t j = 0; j <= n.y; ++j) {
    const float t = static_cast<float>(j) / static_cast<float>(n.y);
    for (std::uint32_t i = 0; i < n.x; ++i) {
      const double u = static_cast<double>(i) / n.x;
      const float bark = 0.03F * static_cast<float>(turn(u * 7 + t).x);
      mesh.positions.push_back(turned((0.2F + bark) * (1.25F - t), 2.2F * t, -u));
      mesh.colours.emplace_back(0.13F, 0.085F, 0.05F, 1.0F);
    }
  }
  append_grid_triangles(mesh, n.x, n.y + 1, true, false);

  // A leaf is one triangle, away from the middle of its clump.
  constexpr std::uint32_t kClumps = 40;
  Random random(seed, 3);
  std::vector<glm::vec4> clumps;
  const auto in_ball = [&random] {
    glm::vec3 p(2.0F);
    while (glm::dot(p, p) > 1.0F || glm::dot(p, p) < 0.01F) {
      p = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    }
    return p;
  };
  for (std::uint32_t i = 0; i < kClumps; ++i) {
    const glm::vec3 p = in_ball() * glm::vec3(0.95F, 0.85F, 0.95F) + glm::vec3(0, 2.5F, 0);
    clumps.emplace_back(p, random.between(0.25F, 0.5F));
  }
  const std::uint64_t leaves =
      triangles > mesh.triangles.size() ? triangles - mesh.triangles.size() : 1;
  const float size = 2.6F / std::sqrt(static_cast<float>(leaves));
  for (std::uint64_t i = 0; i < leaves; ++i) {
    const glm::vec4 clump = clumps[random.below(kClumps)];
    const glm::vec3 out = glm::normalize(in_ball());
    const glm::vec3 p = glm::vec3(clump) + out * clump.w * random.between(0.7F, 1.0F);
    const glm::vec3 u =
        glm::normalize(glm::cross(out + in_ball() * 0.4F, glm::vec3(0.3F, 1, 0.2F)));
    const glm::vec3 v = glm::normalize(glm::cross(out, u) + in_ball() * 0.4F);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(p - u * size);
    mesh.positions.push_back(p + u * size);
    mesh.positions.push_back(p + v * (2.2F * size));
    const glm::vec3 green = glm::vec3(0.07F, 0.17F, 0.03F) * random.between(0.6F, 1.5F);
    mesh.colours.resize(mesh.positions.size(), glm::vec4(green, 1.0F));
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

Mesh make_ground(float half) {
  Mesh mesh;
  mesh.name = "ground";
  mesh.material = 1;
  append_quad(mesh, {-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half}, 4);
  return mesh;
}

}  // namespace

Scene generate_field(std::uint64_t triangles, std::uint64_t seed) {
  const std::uint64_t count =
      std::clamp<std::uint64_t>(triangles / kLeastModel, 1, std::uint64_t{kColumns} * kRows);
  const std::uint64_t each = std::max(kLeastModel, triangles / count);
  constexpr float kGround = 75.0F;
  Scene scene;
  scene.materials = {matte("models", glm::vec3(1.0F), 0.8F),
                     matte("ground", {0.16F, 0.19F, 0.075F}, 0.95F)};
  add_mesh(scene, make_ground(kGround));
  scene.meshes.push_back(make_tree(each, seed));
  scene.meshes.push_back(make_rock(each, seed));
  scene.meshes.push_back(make_column(each));
  scene.meshes.push_back(make_knot(each));
  for (std::uint32_t i = 1; i <= kModels; ++i) compute_normals(scene.meshes[i], 0.5F);

  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(seed, 100 + i);
    const auto column = static_cast<float>(i % kColumns),
               row = std::floor(static_cast<float>(i) / static_cast<float>(kColumns));
    const float x = (column - 0.5F * (kColumns - 1) + random.between(-0.3F, 0.3F)) * kSpacing;
    const float z = (0.5F * kRows - 1.0F - row + random.between(-0.3F, 0.3F)) * kSpacing;
    const float scale = random.between(0.7F, 1.25F);
    const glm::vec2 direction = glm::vec2(turn(random.unit())) * scale;
    scene.instances.push_back(
        {1 + random.below(kModels),
         glm::mat4x3(glm::vec3(direction.x, 0, -direction.y), glm::vec3(0, scale, 0),
                     glm::vec3(direction.y, 0, direction.x), glm::vec3(x, 0, z))});
  }

  Light sun;
  sun.colour = glm::vec3(1.0F, 0.92F, 0.80F) * 2.7F;
  sun.direction = glm::normalize(glm::vec3(0.6F, -0.7F, -0.45F));
  scene.lights.push_back(sun);
  scene.environment.zenith = {0.20F, 0.34F, 0.60F};
  scene.environment.horizon = {0.58F, 0.63F, 0.68F};
  scene.environment.ground = {0.12F, 0.12F, 0.09F};
  Camera camera;
  camera.eye = {0.0F, 6.5F, 0.5F * kRows * kSpacing + 8.0F};
  camera.at = {0.0F, 0.5F, 0.5F * kRows * kSpacing - 18.0F};
  camera.vertical_fov = 45.0F;
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace delray::scenes::internal
