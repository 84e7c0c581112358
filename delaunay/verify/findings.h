// What a verifier of a mesh in pieces has to say against it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace delray::delaunay::internal {

// A simplex of a piece.
struct PieceSimplex {
  std::uint32_t piece = 0, simplex = 0;
};

// As Objection; `of` is empty where it is about no single simplex.
struct PieceObjection {
  std::optional<PieceSimplex> of;
  std::string reason;
};

// The first objection to each property; later ones are not kept.
struct Findings {
  std::optional<PieceObjection> invalid, not_delaunay, not_canonical;

  static void note(std::optional<PieceObjection>& first, std::optional<PieceSimplex> of,
                   std::string reason) {
    if (!first) first = {of, std::move(reason)};
  }
  // Returns false, as those do that find it.
  bool refuse(std::optional<PieceSimplex> of, std::string reason) {
    note(invalid, of, std::move(reason));
    return false;
  }
};

}  // namespace delray::delaunay::internal
