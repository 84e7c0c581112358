// Some of clusters' triangles, with gouraud lit, as messages: what sort-middle sends.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "raster/pipeline/draws.h"
#include "raster/pipeline/prepared_draw.h"
#include "raster/shading/shade_gouraud.h"

namespace delray::raster {

// Some of a cluster's triangles may make two clusters on the rank that gets them, since vertices
// that are lit on both sides count twice: they take the cluster's number and the next.
inline constexpr std::uint32_t kNumbersPerCluster = 2;

// Some triangles of one cluster after the other, for one rank.
struct PackedClusters {
  std::uint64_t triangles = 0;
  std::vector<std::byte> bytes = {};
  const glm::mat4x3* last_transform = nullptr;  // that bytes have
};

// Packs some triangles of one cluster after the other. Memory of a thread.
class ClusterPacker {
 public:
  // What follows is of the triangles at `places`, ascending, of the cluster with this number in the
  // frame's list; with gouraud their vertices are lit.
  void set(const FrameShading& frame, const PreparedDraw& draw, std::uint32_t cluster,
           std::span<const std::uint8_t> places);
  // Appends the triangles at places[i] for the i of `which`, ascending: 40 bytes, 48 where the
  // transform is another one, 3 per triangle and 12 per vertex (mesh coordinates), and per vertex
  // - gouraud: 12 (radiance), 8 with a base colour texture (uv), 16 where alpha counts (colour);
  // - phong: what the mesh has of 12 (normal), 8 with a texture (uv), 8 with one of the second set,
  //   16 with a normal texture (tangent), 16 (colour).
  // A closed mesh has about 0.65 vertices per triangle in a cluster: 19 bytes per triangle with
  // either and normals. Where no two triangles share a vertex, since most are not seen, it is 75.
  void pack(std::span<const std::uint8_t> which, PackedClusters& to);

 private:
  // What becomes one cluster on the rank that gets it.
  struct Section {
    std::uint32_t vertices = 0, triangles = 0;
    std::array<std::uint32_t, kClusterVertices> vertex;    // of the mesh
    std::array<std::uint32_t, kClusterVertices> radiance;  // of lit_, with gouraud
    std::array<std::array<std::uint8_t, kClusterTriangles>, 3> corners;
  };

  void append_section(std::uint32_t number, PackedClusters& to);

  const Draw* draw_ = nullptr;
  const Cluster* places_in_ = nullptr;
  const ClusterBlock* block_ = nullptr;
  std::uint32_t cluster_ = 0;
  std::uint8_t attributes_ = 0;
  std::span<const std::uint8_t> places_;
  std::vector<std::uint32_t> numbers_;
  GouraudTile gouraud_;
  GouraudTile::LitCorners lit_;

  Section section_;  // at hand
};

// A mesh that arrived in a message. Others refer to it: its address must stay.
struct ArrivedMesh {
  scenes::Mesh mesh;
  glm::mat4x3 transform{1.0F};
  std::vector<glm::vec3> radiances;  // of the vertices, with gouraud
  MeshClusters clusters;
};

// What was packed, one after the other, as draws and clusters of the list, which has room for
// their numbers; appends these to `numbers`. Parallel.
void unpack_clusters(std::span<const std::byte> bytes, std::deque<ArrivedMesh>& meshes,
                     DrawList& list, std::vector<std::uint32_t>& numbers);

}  // namespace delray::raster
