// Passes over the points and pieces of a mesh that is verified, by all ranks or one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "comm/communicator.h"
#include "delaunay/verify/findings.h"
#include "delaunay/verify_pieces.h"

namespace delray::delaunay::internal {

// The share of a rank in something that is counted: [begin, end).
struct RankShare {
  std::size_t begin = 0, end = 0;
};
inline RankShare share_of_rank(const comm::Communicator& communicator, std::size_t n) {
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const auto begin = [&](std::size_t i) { return n / ranks * i + std::min(i, n % ranks); };
  return {begin(rank), begin(rank + 1)};
}

// Calls f(point, whether it has a height) for all points of some parts in the order of rows, of
// which the first is `first_row`.
template <class F>
void for_points(const PointParts& points, const RankShare& parts, std::uint64_t first_row, F&& f) {
  PointCloud part;
  std::uint64_t row = first_row;
  for (std::size_t i = parts.begin; i < parts.end; ++i) {
    points.read(i, part);
    for (const glm::dvec3& position : part.positions) f(RowPoint{position, row++}, part.has_z);
  }
}

// A corner of a simplex.
struct PieceCorner {
  RowPoint vertex;
  PieceSimplex of;
};

// Calls f(corner) for each corner of each simplex of the rank's pieces, until it returns true.
template <class F>
void for_corners(const comm::Communicator& communicator, const PieceSource& pieces, F&& f) {
  PieceMesh mesh;
  const auto corners = static_cast<std::size_t>(pieces.dim) + 1;
  const RankShare own = share_of_rank(communicator, pieces.pieces);
  for (std::size_t piece = own.begin; piece < own.end; ++piece) {
    pieces.read(piece, mesh);
    for (std::size_t i = 0; i < mesh.simplices.size(); ++i) {
      const PieceSimplex of{static_cast<std::uint32_t>(piece),
                            static_cast<std::uint32_t>(i / corners)};
      if (f(PieceCorner{mesh.points[mesh.simplices[i]], of})) return;
    }
  }
}

// Collective: the first corner of all pieces that `wanted(corner)` is true for.
template <class Wanted>
std::optional<PieceCorner> first_corner(comm::Communicator& communicator, const PieceSource& pieces,
                                        Wanted&& wanted) {
  struct Told {
    PieceCorner found;
    std::uint64_t exists = 0;
  };
  const Told mine = comm::all_or_none(communicator, comm::Phase::other, [&] {
    Told told;
    for_corners(communicator, pieces, [&](const PieceCorner& found) {
      if (wanted(found)) told = {found, 1};
      return told.exists != 0;
    });
    return told;
  });
  // Pieces of lower ranks come first.
  for (const comm::Buffer& each : comm::all_gather(communicator, comm::Buffer::of_value(mine))) {
    const Told told = each.template as<Told>()[0];
    if (told.exists != 0) return told.found;
  }
  return std::nullopt;
}

}  // namespace delray::delaunay::internal
