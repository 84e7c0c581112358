// Quads, grids, and spheres as octahedra whose rings are cut into as many vertices as their
// distance from the pole asks for, normalized.
#include "scenes/generators/shapes.h"

#include <algorithm>
#include <array>

namespace delray::scenes::internal {

void append_quad(Mesh& mesh, const glm::vec3& corner, const glm::vec3& edge_u,
                 const glm::vec3& edge_v, std::uint32_t n) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::vec3 normal = glm::normalize(glm::cross(edge_u, edge_v));
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(n);
      const float t = static_cast<float>(j) / static_cast<float>(n);
      mesh.positions.push_back(corner + edge_u * s + edge_v * t);
      mesh.normals.push_back(normal);
    }
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t v = first + j * (n + 1) + i;
      mesh.triangles.emplace_back(v, v + 1, v + n + 2);
      mesh.triangles.emplace_back(v, v + n + 2, v + n + 1);
    }
  }
}

Mesh make_sphere(std::uint32_t n) {
  // Ring r from the north pole has 4 min(r, 2n - r) vertices, the poles are single ones; each of
  // its quarters is an edge between two of the octahedron's faces.
  static const std::array<glm::vec3, 4> kAxes = {glm::vec3{1, 0, 0}, glm::vec3{0, 0, -1},
                                                 glm::vec3{-1, 0, 0}, glm::vec3{0, 0, 1}};
  Mesh mesh;
  std::vector<std::uint32_t> first;
  const auto side = [n](std::uint32_t r) { return std::min(r, 2 * n - r); };
  for (std::uint32_t r = 0; r <= 2 * n; ++r) {
    first.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    const std::uint32_t cells = side(r);
    const float height = static_cast<float>(n) - static_cast<float>(r);
    for (std::uint32_t j = 0; j < std::max(1U, 4 * cells); ++j) {
      glm::vec3 p(0, height, 0);
      if (cells > 0) {
        const std::uint32_t quarter = j / cells, k = j % cells;
        p += kAxes[quarter] * static_cast<float>(cells - k) +
             kAxes[(quarter + 1) % 4] * static_cast<float>(k);
      }
      mesh.positions.push_back(glm::normalize(p));
    }
  }
  const auto vertex = [&](std::uint32_t r, std::uint32_t quarter, std::uint32_t k) {
    const std::uint32_t cells = side(r);
    return first[r] + (cells == 0 ? 0 : (quarter * cells + k) % (4 * cells));
  };
  for (std::uint32_t r = 0; r < 2 * n; ++r) {
    const bool north = r < n;
    const std::uint32_t wide = north ? r + 1 : r, narrow = north ? r : r + 1;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh.triangles.push_back(north ? glm::uvec3(a, b, c) : glm::uvec3(a, c, b));
    };
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
      for (std::uint32_t k = 0; k < side(wide); ++k) {
        add(vertex(wide, quarter, k), vertex(wide, quarter, k + 1), vertex(narrow, quarter, k));
        if (k + 1 < side(wide)) {
          add(vertex(wide, quarter, k + 1), vertex(narrow, quarter, k + 1),
              vertex(narrow, quarter, k));
        }
      }
    }
  }
  mesh.normals = mesh.positions;
  return mesh;
}

void append_grid_triangles(Mesh& mesh, std::uint32_t columns, std::uint32_t rows,
                           bool closed_columns, bool closed_rows) {
  const std::uint32_t cells_x = closed_columns ? columns : columns - 1;
  const std::uint32_t cells_y = closed_rows ? rows : rows - 1;
  const std::size_t old = mesh.triangles.size();
  mesh.triangles.resize(old + std::size_t{2} * cells_x * cells_y);
  std::size_t t = old;
  for (std::uint32_t j = 0; j < cells_y; ++j) {
    const std::uint32_t row = j * columns, above = (j + 1) % rows * columns;
    for (std::uint32_t i = 0; i < cells_x; ++i) {
      const std::uint32_t right = (i + 1) % columns;
      mesh.triangles[t++] = {row + i, row + right, above + right};
      mesh.triangles[t++] = {row + i, above + right, above + i};
    }
  }
}

Material matte(std::string name, const glm::vec3& colour, float roughness) {
  Material material;
  material.name = std::move(name);
  material.base_colour = glm::vec4(colour, 1.0F);
  material.roughness = roughness;
  return material;
}

void add_mesh(Scene& scene, Mesh&& mesh, const glm::mat4x3& transform) {
  scene.instances.push_back({static_cast<std::uint32_t>(scene.meshes.size()), transform});
  scene.meshes.push_back(std::move(mesh));
}

}  // namespace delray::scenes::internal
