// What a verifier of a mesh in pieces has to say against it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "comm/communicator.h"

namespace delray::delaunay::internal {

// A simplex of a piece.
struct PieceSimplex {
  std::uint32_t piece = 0, simplex = 0;
};

// As Objection; `of` is empty where it is about no single simplex.
struct PieceObjection {
  std::optional<PieceSimplex> of;
  std::string reason;
  bool unknown_vertex = false;  // that is none of the points

  // Of several the first is told: that of the first simplex.
  bool precedes(const PieceObjection& other) const {
    if (!of || !other.of) return of && !other.of;
    return std::tie(of->piece, of->simplex, reason) <
           std::tie(other.of->piece, other.of->simplex, other.reason);
  }
};

// The first objection to each property, in whatever order they are found.
struct Findings {
  std::optional<PieceObjection> invalid, not_delaunay, not_canonical;

  static void note(std::optional<PieceObjection>& first, PieceObjection found) {
    if (!first || found.precedes(*first)) first = std::move(found);
  }
  // Returns false, as those do that find it.
  bool refuse(std::optional<PieceSimplex> of, std::string reason, bool unknown_vertex = false) {
    note(invalid, {of, std::move(reason), unknown_vertex});
    return false;
  }
  // Collective: the first of those of all ranks.
  void agree(comm::Communicator& communicator);
};

}  // namespace delray::delaunay::internal
