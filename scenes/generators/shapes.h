// Shapes that the generated scenes are made of.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

#include "scenes/scene.h"

namespace delray::scenes::internal {

// Appends to `mesh` the parallelogram corner + s*edge_u + t*edge_v as n x n cells of two triangles,
// seen from the side of cross(edge_u, edge_v), with normals. REQUIRES: n >= 1.
void append_quad(Mesh& mesh, const glm::vec3& corner, const glm::vec3& edge_u,
                 const glm::vec3& edge_v, std::uint32_t n = 1);

// The unit sphere as an octahedron whose edges are cut into n parts: 8 n^2 triangles, with normals.
// REQUIRES: n >= 1.
Mesh make_sphere(std::uint32_t n);

// The grid of vertices (i, j), i < columns, j < rows, row by row, as two triangles a cell whose
// normal is that of cross(along i, along j). With a `closed` direction the last column (row) is
// joined to the first; otherwise there is one cell fewer than vertices.
void append_grid_triangles(Mesh& mesh, std::uint32_t columns, std::uint32_t rows,
                           bool closed_columns, bool closed_rows);

// A material without metal or texture.
Material matte(std::string name, const glm::vec3& colour, float roughness = 0.8F);

// Adds a mesh and one instance of it.
void add_mesh(Scene& scene, Mesh&& mesh, const glm::mat4x3& transform = glm::mat4x3(1.0F));

}  // namespace delray::scenes::internal
