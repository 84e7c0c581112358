// The verifier for meshes that memory need not hold: piece by piece, against points part by part.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/mesh_folder.h"
#include "delaunay/point_parts.h"
#include "files/memory_budget.h"

namespace delray::delaunay {

// A mesh in pieces: simplices with their points, of which each piece has every one once. `read`
// replaces its argument by a piece, again and again with equal results; one thread of each rank
// calls it at a time.
struct PieceSource {
  int dim = 2;
  std::size_t pieces = 0;
  std::function<void(std::size_t piece, PieceMesh& mesh)> read;
  std::vector<std::uint64_t> simplices = {};  // of each piece; empty: not known before
};

// What verify_pieces() finds.
struct PiecesVerdict {
  // As in Verdict: each includes those before it.
  bool valid = false, delaunay = false, canonical = false;
  // The first simplex that breaks the first property which fails, where it is about one: its piece,
  // and its place there.
  std::optional<std::size_t> piece, simplex;
  std::string reason;  // one sentence about that; empty if canonical
  // Whether that is a vertex that is none of the points: a row that does not exist, or another
  // place than that of the row.
  bool unknown_vertex = false;
  // In 2D whether z is that of the points: empty where points or mesh have none.
  std::string heights;       // "equal", "different"
  std::string other_height;  // one sentence about the first that is different

  std::uint64_t points = 0, distinct = 0, simplices = 0, hull_facets = 0;
  Hash128 hash;  // of the simplices as they are; complete only if valid

  bool operator==(const PiecesVerdict&) const = default;
};

// How pieces are verified.
struct VerifyPiecesOptions {
  std::string name;  // of the mesh, for messages
  files::MemoryBudget memory;
  std::filesystem::path scratch;  // for borders that do not fit; empty: the system's folder
};

// Checks exactly that simplices of pieces together are the Delaunay triangulation of the points, or
// at least a triangulation, as verify_simplices() does for one in memory. Collective: each rank
// looks at a run of pieces and of parts of the points, and all return the same, whatever their
// number.
//
// Memory of a rank: a piece, the adjacency of it or, where that is beyond a quarter of `memory` and
// the source tells how many simplices pieces have, of a run of its simplices; a part of the points,
// a bit for each row, and facets and vertices on the borders of pieces and runs, of which those
// beyond an eighth of `memory` wait in a file without a name. Cost: pieces are read once, points
// once by one rank and twice by several; pieces once more if rows are equal to others, and once to
// name what is wrong with rows.
//
// Throws, on all ranks, what the sources throw, FileError (memory) where there is no room for bits
// and the hull, naming `name`, and FileError (device) for a scratch folder that is full.
PiecesVerdict verify_pieces(comm::Communicator& communicator, const PieceSource& pieces,
                            const PointParts& points, const VerifyPiecesOptions& options);

// As above, by one rank in the caller's arena.
PiecesVerdict verify_pieces(const PieceSource& pieces, const PointParts& points,
                            const std::string& name, const files::MemoryBudget& memory = {});

}  // namespace delray::delaunay
