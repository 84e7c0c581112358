// A rank's part of a mesh that is being refined, and how triangles travel between ranks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "delaunay/distributed/packing.h"
#include "delaunay/refinement/refinement_mesh.h"

namespace delray::delaunay::internal {

// A triangle, vertex or corner by its number at the rank that it belongs to.
struct PartId {
  std::uint32_t rank = 0, number = 0;
  friend bool operator==(const PartId&, const PartId&) = default;
};

// A triangle in a message; the vertices by their places in the message's list.
struct TriangleRecord {
  PartId id;
  std::array<std::uint32_t, 3> vertices;
  std::array<PartId, 3> neighbours;  // corners
  std::uint32_t marks;
};
struct VertexRecord {
  PartId id;
  glm::dvec2 position;
  SegmentEnds ends;
  std::uint64_t acute;
};
struct ReachRecord {
  SegmentEnds segment;
  std::uint64_t from;
  double length;
};

// The triangles that belong to the rank, and slots for those of others that it knows of as
// neighbours. What such a slot has is read only while a copy is here, from unpack() to forget().
//
// A triangle keeps its slot, and so its rank, when a cavity gives it other vertices. Vertices that
// were there before the refinement belong to rank 0, others to the rank that made them, whose
// numbers begin with `given`.
class MeshPart {
 public:
  RefinementMesh mesh;

  // Room for so many triangles of the rank, which unpack() fills.
  MeshPart(int rank, SimplexNumber own, VertexNumber given);
  // All of a mesh, of which triangle t goes to triangles[t].
  MeshPart(RefinementMesh&& whole, std::vector<PartId> triangles);

  int rank() const { return static_cast<int>(rank_); }
  bool is_own(SimplexNumber t) const { return triangles_[t].rank == rank_; }
  bool is_here(SimplexNumber t) const { return is_here_[t]; }
  PartId triangle_id(SimplexNumber t) const { return triangles_[t]; }
  PartId corner_id(CornerNumber corner) const {
    const PartId t = triangles_[simplex_of(corner)];
    return {t.rank, delaunay::corner_of(t.number, corner & 3U)};
  }
  PartId vertex_id(VertexNumber v) const { return vertices_[v]; }
  std::size_t given() const { return given_; }
  std::size_t made() const { return made_.size(); }

  // Both make room for triangles that nobody has told of.
  SimplexNumber slot_of(const PartId& triangle);
  CornerNumber corner_of(const PartId& corner) {
    return delaunay::corner_of(slot_of({corner.rank, simplex_of(corner.number)}),
                               corner.number & 3U);
  }
  std::optional<VertexNumber> find_vertex(const PartId& id) const;

  VertexNumber make_vertex();
  SimplexNumber make_triangle();

  // Triangles with their vertices, and what cutting their pieces takes.
  void pack(std::span<const SimplexNumber> triangles, Packer& to);
  // Returns the triangles. Throws comm::BadMessage.
  std::vector<SimplexNumber> unpack(Unpacker& from);
  // A triangle of another rank, whose copy is of no use any more.
  void forget(SimplexNumber t) { is_here_[t] = false; }

 private:
  SimplexNumber add_slot(const PartId& id);
  VertexNumber add_vertex(const PartId& id);

  std::uint32_t rank_;
  VertexNumber given_;
  std::vector<PartId> triangles_, vertices_;
  std::vector<bool> is_here_;
  std::vector<VertexNumber> made_;                                  // by number from given_ on
  std::unordered_map<std::uint64_t, std::uint32_t> slots_, known_;  // of other ranks
  std::vector<std::uint32_t> places_;                               // for pack()
};

}  // namespace delray::delaunay::internal
