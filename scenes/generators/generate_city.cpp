// A city of blocks: footprints are halved at random until each fits a building, which are higher in
// the middle as a rule.
//
// The plan is made first. A bisection on the size of a window then brings the number of triangles
// nearest to the wanted one, since that number falls as windows grow, and blocks are built in
// parallel from random streams of their own. O(triangles). Degenerate: for few triangles there is
// one block, and a facade has at least one window.
#include <algorithm>
#include <cmath>

#include "parallel/parallel_for.h"
#include "scenes/generators/generators.h"
#include "scenes/generators/shapes.h"
#include "scenes/geometry/noise.h"

namespace delray::scenes::internal {
namespace {

// Lengths are metres.
constexpr float kBlock = 64.0F, kStreet = 18.0F, kPitch = kBlock + kStreet;
constexpr float kPavement = 0.25F;  // height of a block above the streets
constexpr std::uint64_t kTrianglesPerCityBlock =
    9000;                                        // wanted on average; decides how many blocks
constexpr std::uint64_t kTrianglesPerCell = 18;  // a window, its reveal, and the wall around it

struct Building {
  glm::vec3 low;
  glm::vec3 size;
  glm::vec3 wall;  // colour
};

struct Block {
  glm::vec3 corner;
  bool park;
  std::vector<Building> buildings;
};

constexpr glm::vec3 kWalls[] = {{0.46F, 0.42F, 0.36F}, {0.55F, 0.53F, 0.50F},
                                {0.38F, 0.22F, 0.16F}, {0.62F, 0.57F, 0.47F},
                                {0.30F, 0.33F, 0.37F}, {0.50F, 0.38F, 0.29F}};

// A footprint is halved at random until it is small enough for one house; towers get a second,
// narrower storey on top.
void build(Block& block, const glm::vec2& low, const glm::vec2& high, float downtown,
           Random& random) {
  const glm::vec2 size = high - low;
  const bool wide = size.x > size.y;
  const float longest = wide ? size.x : size.y;
  if (longest > 26.0F && (longest > 40.0F || random.unit() < 0.7F)) {
    const float cut = random.between(0.38F, 0.62F);
    const glm::vec2 end =
        wide ? glm::vec2(low.x + size.x * cut, high.y) : glm::vec2(high.x, low.y + size.y * cut);
    const glm::vec2 start = wide ? glm::vec2(end.x, low.y) : glm::vec2(low.x, end.y);
    build(block, low, end, downtown, random);
    build(block, start, high, downtown, random);
    return;
  }
  const float gap = random.between(0.6F, 2.0F);
  const float luck = random.unit();
  const float height =
      8.0F + 14.0F * random.unit() + downtown * (20.0F + 150.0F * luck * luck * luck);
  const glm::vec3 wall = kWalls[random.below(static_cast<std::uint32_t>(std::size(kWalls)))] *
                         random.between(0.75F, 1.15F);
  const glm::vec3 base(low.x + gap, kPavement, low.y + gap);
  const glm::vec3 extent(size.x - 2 * gap, height, size.y - 2 * gap);
  block.buildings.push_back({base, extent, wall});
  if (height > 60.0F && random.unit() < 0.7F) {
    const float inset = random.between(0.12F, 0.25F);
    block.buildings.push_back(
        {base + extent * glm::vec3(inset, 1.0F, inset),
         extent * glm::vec3(1 - 2 * inset, random.between(0.2F, 0.5F), 1 - 2 * inset), wall});
  }
}

std::vector<Block> plan(std::uint32_t side, std::uint64_t seed) {
  std::vector<Block> blocks;
  const float half = 0.5F * static_cast<float>(side);
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      Random random(seed, std::uint64_t{j} << 32 | i);
      const glm::vec2 cell(static_cast<float>(i) - half, static_cast<float>(j) - half);
      const float from_middle = glm::length(cell + 0.5F) / half;
      const float downtown = std::max(0.0F, 1.0F - 1.3F * from_middle);
      Block block{{cell.x * kPitch + 0.5F * kStreet, 0, cell.y * kPitch + 0.5F * kStreet},
                  random.unit() < 0.07F,
                  {}};
      const glm::vec2 low(block.corner.x, block.corner.z);
      if (!block.park) build(block, low + 3.0F, low + kBlock - 3.0F, downtown, random);
      blocks.push_back(std::move(block));
    }
  }
  return blocks;
}

glm::uvec2 cells_of(float width, float height, float cell) {
  return {static_cast<std::uint32_t>(std::max(1.0F, std::floor(width / cell + 0.5F))),
          static_cast<std::uint32_t>(std::max(1.0F, std::floor(height / cell + 0.5F)))};
}

std::uint64_t count_triangles(std::span<const Block> blocks, float cell) {
  std::uint64_t count = 2;
  for (const Block& block : blocks) {
    count += 10;
    for (const Building& b : block.buildings) {
      const glm::uvec2 x = cells_of(b.size.x, b.size.y, cell);
      const glm::uvec2 z = cells_of(b.size.z, b.size.y, cell);
      count += 2 + kTrianglesPerCell * 2 * (std::uint64_t{x.x} * x.y + std::uint64_t{z.x} * z.y);
    }
  }
  return count;
}

// The side of a window cell that brings the city nearest to the wanted number of triangles: the
// number falls as the side grows.
float choose_cell(std::span<const Block> blocks, std::uint64_t triangles) {
  float fine = 0.05F, coarse = 400.0F;
  for (int step = 0; step < 40; ++step) {
    const float middle = std::sqrt(fine * coarse);
    (count_triangles(blocks, middle) > triangles ? fine : coarse) = middle;
  }
  return coarse;
}

struct Facades {
  Mesh walls, windows;
};

void coloured_quad(Mesh& mesh, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v,
                   const glm::vec3& colour) {
  append_quad(mesh, corner, u, v);
  mesh.colours.resize(mesh.positions.size(), glm::vec4(colour, 1.0F));
}

// One cell of a facade: a window set back into the wall.
void add_cell(Facades& facades, const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v,
              const glm::vec3& wall, const glm::vec3& pane) {
  constexpr float kSide = 0.2F, kSill = 0.3F, kLintel = 0.12F;
  const glm::vec3 inward = glm::normalize(glm::cross(v, u)) * (0.08F * glm::length(u));
  const glm::vec3 a = corner + u * kSide + v * kSill;
  const glm::vec3 w = u * (1 - 2 * kSide), h = v * (1 - kSill - kLintel);
  Mesh& walls = facades.walls;
  coloured_quad(walls, corner, u, v * kSill, wall);
  coloured_quad(walls, corner + v * (1 - kLintel), u, v * kLintel, wall);
  coloured_quad(walls, corner + v * kSill, u * kSide, h, wall);
  coloured_quad(walls, a + w, u * kSide, h, wall);
  const glm::vec3 shaded = wall * 0.7F;
  coloured_quad(walls, a, w, inward, shaded);
  coloured_quad(walls, a + h + inward, w, -inward, shaded);
  coloured_quad(walls, a, inward, h, shaded);
  coloured_quad(walls, a + w + inward, -inward, h, shaded);
  coloured_quad(facades.windows, a + inward, w, h, pane);
}

void add_building(Facades& facades, const Building& b, float cell, Random& random) {
  const glm::vec3 x(b.size.x, 0, 0), y(0, b.size.y, 0), z(0, 0, b.size.z);
  const glm::vec3 corners[] = {b.low + z, b.low + x + z, b.low + x, b.low};
  const glm::vec3 edges[] = {x, -z, -x, z};
  for (int side = 0; side < 4; ++side) {
    const glm::uvec2 cells = cells_of(glm::length(edges[side]), b.size.y, cell);
    const glm::vec3 u = edges[side] / static_cast<float>(cells.x);
    const glm::vec3 v = y / static_cast<float>(cells.y);
    for (std::uint32_t j = 0; j < cells.y; ++j) {
      for (std::uint32_t i = 0; i < cells.x; ++i) {
        const glm::vec3 pane = glm::vec3(0.10F, 0.14F, 0.18F) * random.between(0.5F, 1.4F);
        add_cell(facades, corners[side] + u * static_cast<float>(i) + v * static_cast<float>(j), u,
                 v, b.wall, pane);
      }
    }
  }
  coloured_quad(facades.walls, b.low + y + z, x, -z, glm::vec3(0.24F, 0.235F, 0.23F));
}

Facades make_block(const Block& block, float cell, Random random) {
  constexpr glm::vec3 kStone{0.36F, 0.35F, 0.33F}, kGrass{0.09F, 0.19F, 0.05F};
  Facades facades;
  const glm::vec3 x(kBlock, 0, 0), y(0, kPavement, 0), z(0, 0, kBlock), low = block.corner;
  coloured_quad(facades.walls, low + z, x, y, kStone);
  coloured_quad(facades.walls, low + x + z, -z, y, kStone);
  coloured_quad(facades.walls, low + x, -x, y, kStone);
  coloured_quad(facades.walls, low, z, y, kStone);
  coloured_quad(facades.walls, low + y + z, x, -z, block.park ? kGrass : kStone);
  for (const Building& b : block.buildings) add_building(facades, b, cell, random);
  return facades;
}

Mesh make_streets(float half) {
  Mesh mesh;
  mesh.name = "streets";
  mesh.material = 2;
  append_quad(mesh, {-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
  return mesh;
}

}  // namespace

Scene generate_city(std::uint64_t triangles, std::uint64_t seed) {
  const double wanted =
      static_cast<double>(triangles) / static_cast<double>(kTrianglesPerCityBlock);
  const auto side =
      static_cast<std::uint32_t>(std::clamp(std::lround(std::sqrt(wanted)), 1L, 400L));
  const std::vector<Block> blocks = plan(side, seed);
  const float cell = choose_cell(blocks, triangles);
  const float half = 0.5F * static_cast<float>(side) * kPitch;

  Scene scene;
  scene.materials = {matte("walls", glm::vec3(1.0F), 0.85F),
                     matte("windows", glm::vec3(1.0F), 0.08F),
                     matte("streets", glm::vec3(0.075F), 0.9F)};
  scene.materials[1].metallic = 0.35F;
  std::vector<Facades> facades(blocks.size());
  parallel::parallel_for(0, blocks.size(), 1, [&](std::size_t i) {
    facades[i] = make_block(blocks[i], cell, Random(seed + 1, i));
  });
  add_mesh(scene, make_streets(half));
  for (std::size_t i = 0; i < facades.size(); ++i) {
    const std::string name = "block " + std::to_string(i);
    facades[i].walls.name = name + " walls";
    facades[i].windows.name = name + " windows";
    facades[i].windows.material = 1;
    add_mesh(scene, std::move(facades[i].walls));
    if (!facades[i].windows.triangles.empty()) add_mesh(scene, std::move(facades[i].windows));
  }

  Light sun;
  sun.colour = glm::vec3(1.0F, 0.92F, 0.80F) * 2.6F;
  sun.direction = glm::normalize(glm::vec3(0.55F, -0.75F, -0.35F));
  scene.lights.push_back(sun);
  scene.environment.zenith = {0.20F, 0.34F, 0.60F};
  scene.environment.horizon = {0.55F, 0.61F, 0.68F};
  scene.environment.ground = {0.13F, 0.12F, 0.11F};
  Camera camera;
  camera.eye = {0.45F * half, 0.35F * half + 48.0F, 1.25F * half};
  camera.at = {0, 0.02F * half + 18.0F, -0.1F * half};
  camera.vertical_fov = 45.0F;
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace delray::scenes::internal
