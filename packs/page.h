// What a pack is made of: pages of triangles, points or segments, and the table that says where
// they are.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

#include "geometry/box.h"
#include "scenes/scene.h"

namespace delray::packs {

// A cluster is what a rasterizer skips or draws as a whole, a page what is read at once: a few
// clusters of consecutive triangles, with vertices of their own.
inline constexpr std::uint32_t kClusterTriangles = 128, kClusterVertices = 256;
inline constexpr std::uint32_t kPageClusters = 4;
// A cluster's corners are stored for a multiple of so many triangles.
inline constexpr std::uint32_t kCornerPadding = 16;

// Bounds of normals: that of every triangle, of its counter-clockwise side, is within the angle of
// this cosine around `axis`. No cone: cosine = -1.
struct NormalCone {
  glm::vec3 axis{0, 0, 1};
  float cosine = -1;
  float least_height = 0;  // of all triangles: no two opposite parts of one are closer
};

// Triangles [first, first + count) of a page.
struct PageCluster {
  std::uint32_t first = 0, count = 0;
  std::uint32_t first_vertex = 0, vertices = 0;  // into Page::vertices
  std::uint32_t first_corner = 0;                // into Page::corners
  geometry::Box3 box;
  NormalCone cone;
  // Whether the own normal of each corner is on the counter-clockwise side of its triangle.
  bool normals_agree = false;

  std::uint32_t corner_stride() const {
    return (count + kCornerPadding - 1) / kCornerPadding * kCornerPadding;
  }
};

// The content of a page.
struct Page {
  scenes::Mesh mesh;  // without a name
  std::vector<PageCluster> clusters;
  std::vector<std::uint32_t> vertices;  // of the mesh, cluster by cluster
  // By cluster: the first corners of its triangles, as numbers among the cluster's vertices, then
  // the second, then the third.
  std::vector<std::uint8_t> corners;

  std::uint64_t bytes() const;  // in memory
};

// Which attributes the vertices of a mesh have.
struct Attributes {
  bool normals = false, uvs = false, uvs2 = false, tangents = false, colours = false;
  std::uint32_t bytes() const {  // of a vertex, without its position
    return 12U * normals + 8U * uvs + 8U * uvs2 + 16U * tangents + 16U * colours;
  }
  bool operator==(const Attributes&) const = default;
};
Attributes attributes_of(const scenes::Mesh& mesh);

inline constexpr std::uint32_t kNoGroup = 0xFFFFFFFFU;

// Neighbouring pages that were simplified together: their outer border stayed as it was, so that
// either they or what was made of them can be drawn beside any choice for their neighbours.
struct Group {
  geometry::Box3 bounds;  // of all that was simplified, down to the finest level
  // How far the simplified surface and the finest one are apart at most, in either direction; no
  // less than that of any group which its pages come from.
  float error = 0;
};

// A page in the table.
struct PageRow {
  std::uint64_t offset = 0;    // of its first byte in the file
  std::uint64_t checksum = 0;  // XXH3-64 of its bytes
  std::uint32_t bytes = 0;
  // The number of its first triangle in the mesh, the others follow; of a coarser level among all
  // triangles of that level.
  std::uint32_t first = 0;
  std::uint16_t triangles = 0, vertices = 0;
  std::uint16_t references = 0;  // elements of Page::vertices
  std::uint8_t clusters = 0, level = 0;
  geometry::Box3 box;
  NormalCone cone;
  // The groups that it was made of, none at level 0, and that it was simplified with.
  std::uint32_t made_of = kNoGroup, simplified_in = kNoGroup;

  // Of a Page, about.
  std::uint64_t bytes_in_memory(const Attributes& attributes) const;
};

// Pages [first, first + count) of the table.
struct PageRange {
  std::uint32_t first = 0, count = 0;
};

// A mesh in the table.
struct MeshRow {
  std::string name;
  scenes::Shape shape;
  std::uint32_t material = 0;
  Attributes attributes;
  std::uint64_t triangles = 0, vertices = 0;  // as they were packed
  geometry::Box3 box;                         // of all vertices that triangles have
  std::vector<PageRange> levels;              // the finest first, which has all triangles
};

}  // namespace delray::packs
