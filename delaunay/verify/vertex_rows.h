// Whether the vertices of pieces are the points of their rows, and all of these.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "delaunay/verify/findings.h"
#include "delaunay/verify/piece_borders.h"
#include "delaunay/verify/row_fingerprints.h"
#include "delaunay/verify_pieces.h"

namespace delray::delaunay::internal {

// Takes pieces first, all of them, then looks at the points. Why it suffices: 6. of
// verify_pieces.cpp.
template <int D>
class VertexRows {
 public:
  using Point = glm::vec<D, double>;

  VertexRows(const PieceSource& pieces, const PointParts& points, const std::string& name,
             const files::MemoryBudget& memory);

  // Takes the vertices of a piece, whose facets are matched within it. False where one of its rows
  // is not one of the points, or a vertex of simplices elsewhere.
  bool add(std::uint32_t piece, const VerifiedMesh<D>& mesh, std::span<const RowPoint> points,
           Findings& findings);

  // Compares with the points, and counts them. False where a vertex is not the point of its row, or
  // a point is no vertex and equals none.
  bool check_points(PiecesVerdict& verdict, Findings& findings);
  // As above, where there are no simplices: all points have to be flat.
  bool check_flat(PiecesVerdict& verdict, Findings& findings);

 private:
  enum VertexKind : std::uint8_t { kUnused, kInner, kBorder };
  using Range = RowFingerprints::Range;
  // A vertex and a simplex that has it.
  struct Found {
    RowPoint vertex;
    PieceSimplex of;
  };

  static std::uint64_t most_rows(const PointParts& points);
  static std::vector<std::uint8_t> kinds_of_vertices(const VerifiedMesh<D>& mesh);
  static PieceSimplex simplex_with(std::uint32_t piece, const VerifiedMesh<D>& mesh,
                                   std::size_t vertex);
  void add_pair(const RowPoint& point);
  bool check_unused(const std::vector<RowPoint>& unused, Findings& findings);
  void compare_heights(PiecesVerdict& verdict);
  std::optional<Found> find_different(const Range& range, int compared, std::string& reason);
  template <class F>
  void for_points(F&& f) const;
  template <class F>
  void for_vertices(F&& f) const;

  const PieceSource& pieces_;
  const PointParts& points_;
  const std::string& name_;
  const files::MemoryBudget& memory_;
  std::uint64_t rows_;  // at least as many as there are points
  RowMarks marks_;
  RowFingerprints places_, heights_;
  BorderVertices<D> border_;
  std::atomic<bool> mesh_has_heights_{false};
  bool points_have_heights_ = false;
};

extern template class VertexRows<2>;
extern template class VertexRows<3>;

}  // namespace delray::delaunay::internal
