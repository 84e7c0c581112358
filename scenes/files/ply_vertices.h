// Vertices of a PLY file: which properties are which attribute, and rows of them as such.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "geometry/box.h"
#include "scenes/files/ply_header.h"
#include "scenes/files/ply_rows.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {

// How the values of a vertex become attributes.
struct VertexLayout {
  enum Slot : std::uint8_t { kX, kY, kZ, kNx, kNy, kNz, kR, kG, kB, kA, kU, kV, kSlots };

  std::vector<Slot> slots;  // of each property; kSlots: none
  std::array<bool, kSlots> has{};
  std::array<double, kSlots> scale{};
  std::array<PlyType, kSlots> type{};
  std::array<std::size_t, kSlots> offset{};  // in a binary row without lists
  std::size_t stride = 0;                    // 0 with lists

  explicit VertexLayout(const PlyElement& element);

  bool normals() const { return has[kNx] && has[kNy] && has[kNz]; }
  bool uvs() const { return has[kU] && has[kV]; }
  bool colours() const { return has[kR] && has[kG] && has[kB]; }
  // Positions that single precision holds as they are.
  bool single() const;
  // Three floats behind each other, and nothing else of interest.
  bool bare() const;
};

// A texture coordinate of the file; v of PLY grows upwards.
glm::vec2 usable_uv(double u, double v);

// Reads runs of rows into arrays. From any thread.
class PlyVertexReader {
 public:
  // Refers to both. Fails without x or y.
  PlyVertexReader(const PlyFile& file, const PlyElement& element);

  const VertexLayout& layout() const { return layout_; }
  // Whether positions are read as they are in the file, into the mesh rather than `places`.
  bool direct() const { return direct_; }
  // Makes room for so many vertices, of the attributes that there are.
  void allocate(std::uint64_t count, Mesh& mesh, std::vector<glm::dvec3>& places) const;
  // The rows of a block into the elements from `to` on, and the box of their positions.
  geometry::Box3d read(const PlyBlock& block, std::uint64_t to, Mesh& mesh,
                       std::vector<glm::dvec3>& places) const;

 private:
  bool read_bare(const PlyBlock& block, std::uint64_t to, Mesh& mesh, geometry::Box3d& all) const;

  const PlyFile& file_;
  const PlyElement& element_;
  VertexLayout layout_;
  bool direct_;
};

}  // namespace delray::scenes::internal
