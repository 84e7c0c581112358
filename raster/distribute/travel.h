// Groups of primitives as messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "comm/buffer.h"
#include "raster/pipeline/draws.h"

namespace delray::raster {

// Some groups of one instance, cut into clusters as their sender had them. Pieces refer to it: its
// address must stay.
struct TravelledMesh {
  scenes::Mesh mesh;
  glm::mat4x3 transform{1.0F};
  MeshClusters clusters;  // one block
};

// A group that came in a message, and what it is a piece of: the scene's own mesh, or one that
// lives as long as any of its groups.
struct Arrival {
  Piece piece;
  std::shared_ptr<TravelledMesh> mesh;  // null: the scene's
};

// Packs pieces of the scene's meshes as their clusters, with the vertices that these use: all that
// rendering them needs but materials, textures and lights. Pieces that follow each other in an
// instance become one mesh of at most kTravelledTriangles, so that the receiver draws few meshes
// and keeps little that it no longer needs.
//
// 3 bytes a triangle and, for each of a cluster's vertices, 12 (position) and what the mesh has of
// normals (12), uvs (8 for each set), tangents (16) and colours (16); 80 bytes a cluster.
class GeometryPacker {
 public:
  static constexpr std::uint32_t kTravelledTriangles = 1U << 13;

  // `clusters` has those of the pieces' meshes, which are made where they are missing. O(clusters),
  // and O(triangles) of clusters that a piece has a part of.
  GeometryPacker(std::span<const Piece> pieces, SceneClusters& clusters);

  std::size_t bytes() const { return bytes_; }
  // O(bytes), in parallel. REQUIRES: there is room for bytes().
  void write(std::byte* to) const;

 private:
  // Triangles [begin, end) of a cluster.
  struct Part {
    const ClusterBlock* block;
    const MeshCluster* cluster;
    std::uint32_t begin, end;
    // Where only some of the cluster's triangles travel, their vertices and corners are
    // renumbered: first elements of used_ and corners_.
    std::uint32_t first_used, first_corner, vertices;

    std::uint32_t triangles() const { return end - begin; }
    bool is_whole() const { return triangles() == cluster->count; }
  };
  // Pieces that become one mesh.
  struct Run {
    std::span<const Piece> pieces;
    std::size_t first_part = 0, last_part = 0;
    std::uint32_t triangles = 0, vertices = 0, corners = 0;
    std::size_t begin = 0;  // in the message
  };

  void add_parts(const Piece& piece, const MeshClusters& clusters, Run& run);
  void renumber(Part& part);
  std::span<const std::uint32_t> vertices_of(const Part& part) const;
  void write_run(const Run& run, std::byte* to) const;

  std::vector<Run> runs_;
  std::vector<Part> parts_;
  std::vector<std::uint32_t> used_;
  std::vector<std::uint8_t> corners_;
  std::size_t bytes_ = 0;
};

// Appends what GeometryPacker wrote. O(bytes), in parallel.
void unpack_geometry(std::span<const std::byte> message, std::vector<Arrival>& arrivals);

// Numbers only: the receiver has the scene. `first_primitives` as in pieces_of.
std::vector<std::uint64_t> pack_numbers(std::span<const Piece> pieces);
void unpack_numbers(std::span<const std::byte> message, const scenes::Scene& scene,
                    std::span<const std::uint64_t> first_primitives,
                    std::vector<Arrival>& arrivals);

}  // namespace delray::raster
