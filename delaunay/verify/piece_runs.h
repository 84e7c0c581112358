// Pieces that are too large for the memory, as runs of their simplices.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "delaunay/verify_pieces.h"

namespace delray::delaunay::internal {

// A mesh in pieces of which none has more than so many simplices: larger ones are cut into runs of
// their simplices, in their order, with those of their points that are corners of these. Any set of
// simplices may be a piece.
//
// A rank reads a piece once for all runs of it that follow each other, and holds it meanwhile.
class PieceRuns {
 public:
  // REQUIRES: `source` outlives the runs; most >= 1. What the source says nothing about is not cut.
  PieceRuns(const PieceSource& source, std::uint64_t most);
  PieceRuns(const PieceRuns&) = delete;
  PieceRuns& operator=(const PieceRuns&) = delete;

  // Whose pieces are the runs. Lives as long as this.
  const PieceSource& pieces() const { return pieces_; }
  // Names piece and simplex as the source does.
  void name_in_source(PiecesVerdict& verdict) const;

 private:
  struct Run {
    std::size_t piece = 0;
    std::uint64_t first = 0, last = std::numeric_limits<std::uint64_t>::max();  // simplices
  };
  void read(const Run& run, PieceMesh& mesh);

  const PieceSource& source_;
  std::vector<Run> runs_;
  PieceSource pieces_;
  PieceMesh whole_;  // the piece of the last run that was read, if that is cut
  std::size_t held_ = std::numeric_limits<std::size_t>::max();  // its number
};

}  // namespace delray::delaunay::internal
