// Whether the vertices of pieces are the points of their rows, and all of these.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/verify/border_records.h"
#include "delaunay/verify/findings.h"
#include "delaunay/verify/piece_borders.h"
#include "delaunay/verify/read_again.h"
#include "delaunay/verify/row_fingerprints.h"
#include "delaunay/verify_pieces.h"

namespace delray::delaunay::internal {

// Takes pieces first, all of them, then looks at the points. Why it suffices: 6. of
// verify_pieces.cpp. Each rank keeps the rows of its own parts of the points once all ranks have
// told what they have met.
template <int D>
class VertexRows {
 public:
  using Point = glm::vec<D, double>;

  // Collective.
  VertexRows(comm::Communicator& communicator, const PieceSource& pieces, const PointParts& points,
             const VerifyPiecesOptions& options, const RecordsPlace& borders);

  // Takes the vertices of a piece, whose facets are matched within it. False where one of its rows
  // is not one of the points.
  bool add(std::uint32_t piece, const VerifiedMesh<D>& mesh, std::span<const RowPoint> points,
           Findings& findings);

  // Collective, all of these, with the same result on all ranks.
  //
  // Puts together what ranks have added. False where a row is a vertex of simplices apart.
  bool put_together(Findings& findings);
  // Compares with the points, and counts them. False where a vertex is not the point of its row, or
  // a point is no vertex and equals none.
  bool check_points(PiecesVerdict& verdict, Findings& findings);

 private:
  enum VertexKind : std::uint8_t { kUnused, kInner, kBorder };
  using Range = RowFingerprints::Range;
  static constexpr std::uint64_t kNoRow = ~std::uint64_t{0};

  std::uint64_t most_rows() const;
  static std::vector<std::uint8_t> kinds_of_vertices(const VerifiedMesh<D>& mesh);
  void add_pair(const RowPoint& point);
  void note_doubled(std::uint64_t row);
  void find_own_rows();
  void exchange_marks();
  void take_places(std::span<BorderVertex> vertices, Findings& findings,
                   std::vector<std::uint64_t>& rows);
  void mark_rows(std::vector<std::uint64_t>& rows);
  bool refuse_doubled(std::uint64_t row, Findings& findings);
  std::uint64_t least_of_all(std::uint64_t row) const;
  bool check_unused(const std::vector<RowPoint>& unused, Findings& findings);
  void compare_heights(PiecesVerdict& verdict);
  std::optional<PieceCorner> find_different(const Range& range, int compared, std::string& reason);

  comm::Communicator& communicator_;
  const PieceSource& pieces_;
  const PointParts& points_;
  const std::string& name_;
  const files::MemoryBudget& memory_;
  std::uint64_t rows_;  // at least as many as there are points
  RowMarks marks_;
  RowFingerprints places_, heights_;
  BorderRecords<BorderVertex> border_;
  std::atomic<std::uint64_t> doubled_{kNoRow};  // the lowest row that is met twice
  std::vector<std::uint64_t> begins_;           // of the rows that each rank has, and the end
  std::uint64_t own_first_ = 0;                 // row of the first own point
  std::atomic<bool> mesh_has_heights_{false};
  bool points_have_heights_ = false;
};

extern template class VertexRows<2>;
extern template class VertexRows<3>;

}  // namespace delray::delaunay::internal
