// A fractal height field: octaves of gradient noise (Perlin 2002), each damped where those before
// it are steep, as erosion does (Quilez 2008).
//
// Vertices and cells are numbered in strips of a few rows, so that neighbours lie together in
// memory and a part of the terrain is a run of strips. A part evaluates the noise beyond its border
// for normals, so that parts join without a seam. O(triangles * octaves), parallel. Degenerate:
// with more parts than strips some parts are empty.
#include <algorithm>
#include <cmath>

#include "parallel/parallel_for.h"
#include "scenes/generators/generators.h"
#include "scenes/generators/shapes.h"
#include "scenes/geometry/noise.h"

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kRowsPerBlock = 4;  // hundreds of vertices, each with several octaves
constexpr float kRelief = 0.46F;          // height of the mountains; the terrain is 2 wide
constexpr float kWater = -0.035F;         // height of the lakes

// Noise summed over octaves, each damped where those before it are steep, which leaves valleys
// smooth and ridges rough as erosion does (Quilez 2008).
float height_at(std::uint64_t seed, glm::vec2 p, int octaves) {
  float sum = 0, amplitude = 1;
  glm::vec2 slope(0);
  for (int octave = 0; octave < octaves; ++octave) {
    const NoiseSample n = noise(seed + static_cast<std::uint64_t>(octave), p);
    slope += glm::vec2(n.gradient) * amplitude;
    sum += amplitude * n.value / (1.0F + glm::dot(slope, slope));
    amplitude *= 0.5F;
    // Turned by an angle with tangent 3/4, so that the lattices of the octaves do not line up.
    p = glm::vec2(0.8F * p.x - 0.6F * p.y, 0.6F * p.x + 0.8F * p.y) * 2.0F;
  }
  return std::max(sum * kRelief * 1.6F, kWater);
}

float blend(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

glm::vec4 colour_at(std::uint64_t seed, const glm::vec3& p, const glm::vec3& normal) {
  constexpr glm::vec3 kLake{0.035F, 0.11F, 0.17F}, kSand{0.42F, 0.34F, 0.20F};
  constexpr glm::vec3 kGrass{0.10F, 0.20F, 0.045F}, kForest{0.035F, 0.09F, 0.025F};
  constexpr glm::vec3 kRock{0.23F, 0.205F, 0.18F}, kSnow{0.85F, 0.88F, 0.92F};
  if (p.y <= kWater) return {kLake, 1.0F};
  const float patches = noise(seed + 77, glm::vec2(p.x, p.z) * 9.0F).value;
  const float height = p.y + 0.03F * patches;
  glm::vec3 colour = glm::mix(kGrass, kForest, blend(-0.3F, 0.3F, patches));
  colour = glm::mix(kSand, colour, blend(kWater, kWater + 0.02F, height));
  colour = glm::mix(colour, kRock, blend(0.08F, 0.16F, height));
  colour = glm::mix(kRock, colour, blend(0.70F, 0.86F, normal.y));
  colour = glm::mix(colour, kSnow, blend(0.15F, 0.20F, height) * blend(0.55F, 0.75F, normal.y));
  return {colour, 1.0F};
}

// The vertices in `columns` x `rows`, and the cells between them, are numbered column by column in
// strips of a few rows, so that what is close together in the terrain is so in memory too.
class Strips {
 public:
  static constexpr std::size_t kRows = 8;

  Strips(std::size_t columns, std::size_t rows) : columns_(columns), rows_(rows) {}
  // The number of element i of row j.
  std::size_t number(std::size_t i, std::size_t j) const {
    const std::size_t first = j / kRows * kRows;
    return first * columns_ + i * std::min(kRows, rows_ - first) + (j - first);
  }
  // Calls f(i, j) for every element.
  template <class F>
  void for_each(F&& f) const {
    parallel::parallel_for(0, rows_, kRowsPerBlock, [&](std::size_t j) {
      for (std::size_t i = 0; i < columns_; ++i) f(i, j);
    });
  }

 private:
  std::size_t columns_, rows_;
};

// The vertices, of n x n, on the borders of the rows of cells from `first` to `last`, and these
// cells, with numbers of their own. REQUIRES: first is a multiple of Strips::kRows.
Mesh height_field(std::uint32_t n, std::uint64_t seed, std::size_t first, std::size_t last) {
  Mesh mesh;
  mesh.name = "terrain";
  const std::size_t rows = last - first + 1;
  const std::size_t vertices = n * rows;
  mesh.positions.resize(vertices);
  mesh.normals.resize(vertices);
  mesh.colours.resize(vertices);
  const float spacing = 2.0F / static_cast<float>(n - 1);
  int octaves = 4;  // the last one has waves of a few cells
  while (octaves < 12 && (1U << octaves) * 4 < n) ++octaves;
  const auto position = [&](std::size_t i, std::size_t row) {
    const float x = -1.0F + static_cast<float>(i) * spacing;
    const float z = -1.0F + static_cast<float>(row) * spacing;
    return glm::vec3(x, height_at(seed, glm::vec2(x, z) * 1.15F, octaves), z);
  };
  const Strips points(n, rows);
  points.for_each([&](std::size_t i, std::size_t j) {
    mesh.positions[points.number(i, j)] = position(i, first + j);
  });
  // Beside a part there may be more of the terrain.
  const auto neighbour = [&](std::size_t i, std::size_t row) {
    return row >= first && row <= last ? mesh.positions[points.number(i, row - first)]
                                       : position(i, row);
  };
  points.for_each([&](std::size_t i, std::size_t j) {
    const std::size_t row = first + j;
    const std::size_t left = i == 0 ? i : i - 1, right = std::min<std::size_t>(i + 1, n - 1);
    const std::size_t below = row == 0 ? row : row - 1,
                      above = std::min<std::size_t>(row + 1, n - 1);
    const glm::vec3 x = neighbour(right, row) - neighbour(left, row);
    const glm::vec3 z = neighbour(i, above) - neighbour(i, below);
    const std::size_t v = points.number(i, j);
    mesh.normals[v] = glm::normalize(glm::cross(z, x));
    mesh.colours[v] = colour_at(seed, mesh.positions[v], mesh.normals[v]);
  });
  const Strips cells(n - 1, rows - 1);
  mesh.triangles.resize(std::size_t{2} * (n - 1) * (rows - 1));
  cells.for_each([&](std::size_t i, std::size_t j) {
    const auto corner = [&](std::size_t right, std::size_t above) {
      return static_cast<std::uint32_t>(points.number(i + right, j + above));
    };
    // Along i runs x and along j runs z, whose cross product points down.
    const std::size_t t = 2 * cells.number(i, j);
    mesh.triangles[t] = {corner(0, 0), corner(1, 1), corner(1, 0)};
    mesh.triangles[t + 1] = {corner(0, 0), corner(0, 1), corner(1, 1)};
  });
  return mesh;
}

// Vertices along a side.
std::uint32_t side_of(std::uint64_t triangles) {
  const double cells = std::sqrt(static_cast<double>(std::max<std::uint64_t>(triangles, 2)) / 2);
  return static_cast<std::uint32_t>(std::lround(std::max(1.0, cells))) + 1;
}

Scene terrain_of(Mesh&& mesh) {
  Scene scene;
  scene.materials.push_back(matte("terrain", glm::vec3(1.0F), 0.9F));
  add_mesh(scene, std::move(mesh));

  Light sun;
  sun.colour = glm::vec3(1.0F, 0.93F, 0.82F) * 2.9F;
  sun.direction = glm::normalize(glm::vec3(0.62F, -0.55F, -0.42F));
  scene.lights.push_back(sun);
  scene.environment.zenith = {0.22F, 0.36F, 0.62F};
  scene.environment.horizon = {0.52F, 0.60F, 0.68F};
  scene.environment.ground = {0.10F, 0.10F, 0.09F};
  Camera camera;
  camera.eye = {0.30F, 0.98F, 1.78F};
  camera.at = {0.0F, 0.0F, 0.10F};
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace

Scene generate_terrain(std::uint64_t triangles, std::uint64_t seed) {
  const std::uint32_t n = side_of(triangles);
  return terrain_of(height_field(n, seed, 0, n - 1));
}

ScenePart generate_terrain_part(std::uint64_t triangles, std::uint64_t seed, int part, int parts) {
  const std::uint32_t n = side_of(triangles);
  const std::uint64_t strips = (n - 1 + Strips::kRows - 1) / Strips::kRows;
  const auto begin = [&](int k) {
    const std::uint64_t strip =
        strips * static_cast<std::uint64_t>(k) / static_cast<std::uint64_t>(parts);
    return std::min<std::uint64_t>(strip * Strips::kRows, n - 1);
  };
  const std::uint64_t first = begin(part), last = begin(part + 1);
  ScenePart result;
  result.scene = terrain_of(first < last ? height_field(n, seed, first, last) : Mesh());
  result.first_triangle = static_cast<std::uint32_t>(2 * first * (n - 1));
  result.triangles = std::uint64_t{2} * (n - 1) * (n - 1);
  result.vertices = std::uint64_t{n} * n;
  return result;
}

}  // namespace delray::scenes::internal
