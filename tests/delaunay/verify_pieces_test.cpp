#include "delaunay/verify_pieces.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "comm/threads.h"
#include "delaunay/generate.h"
#include "delaunay/point_parts.h"
#include "delaunay/verify/piece_runs.h"
#include "files/error.h"
#include "files/memory_budget.h"
#include "tests/delaunay/pieces_in_memory.h"

namespace delray::delaunay {
namespace {

using Pieces = std::vector<PieceMesh>;
using Random = std::mt19937_64;

// The points in parts of uneven lengths, of which some are empty.
class SomeParts : public PointParts {
 public:
  SomeParts(const PointCloud& cloud, std::size_t parts) : cloud_(cloud), parts_(parts) {}
  std::size_t parts() const override { return parts_ + 1; }
  std::uint64_t most_rows(std::size_t part) const override { return end(part) - begin(part) + 3; }
  void read(std::size_t part, PointCloud& points) const override {
    points = {};
    points.has_z = cloud_.has_z;
    points.positions.assign(cloud_.positions.begin() + static_cast<std::ptrdiff_t>(begin(part)),
                            cloud_.positions.begin() + static_cast<std::ptrdiff_t>(end(part)));
  }

 private:
  std::size_t begin(std::size_t part) const {
    return cloud_.size() * std::min(part, parts_) / parts_;
  }
  std::size_t end(std::size_t part) const { return begin(part + 1); }
  const PointCloud& cloud_;
  std::size_t parts_;
};

PointCloud with_equal_points(PointCloud cloud, Random& random) {
  const std::size_t n = cloud.size();
  for (std::size_t i = 0; i < n / 10; ++i) {
    const std::size_t from = random() % n, to = random() % n;
    cloud.positions[to] = cloud.positions[from];
  }
  return cloud;
}

TEST(VerifyPieces, AcceptsWhatTriangulationsGive) {
  Random random(7);
  for (const int dim : {2, 3}) {
    for (const PointGenerator& kind : point_generators()) {
      for (const std::size_t n : {0U, 1U, 3U, 50U, 500U}) {
        SCOPED_TRACE(std::string(kind.name) + ", " + std::to_string(n) + " in " +
                     std::to_string(dim) + "D");
        PointCloud cloud = kind.generate(n, dim, 11);
        if (n > 3) cloud = with_equal_points(cloud, random);
        Options options;
        options.dim = dim;
        const Triangulation whole = triangulate(view(cloud.positions), options).triangulation;
        for (const std::size_t pieces : {1U, 2U, 7U, 40U}) {
          const PiecesVerdict verdict = tests::verify(tests::in_pieces(cloud, dim, pieces), dim,
                                                      SomeParts(cloud, pieces % 5 + 1));
          EXPECT_TRUE(verdict.canonical) << verdict.reason;
          EXPECT_EQ(verdict.reason, "");
          EXPECT_EQ(verdict.points, cloud.size());
          if (pieces == 7) {
            EXPECT_EQ(tests::verify_by_ranks(3, tests::in_pieces(cloud, dim, pieces), dim,
                                             SomeParts(cloud, 3)),
                      verdict);
          }
          if (whole.size() == 0) continue;
          EXPECT_EQ(verdict.distinct, whole.distinct);
          EXPECT_EQ(verdict.simplices, whole.size());
          EXPECT_EQ(verdict.hull_facets, whole.hull_facets);
          EXPECT_EQ(verdict.hash, hash(whole));
        }
      }
    }
  }
}

TEST(VerifyPieces, RefusesNoSimplicesOfPointsThatAreNotFlat) {
  for (const int dim : {2, 3}) {
    const PointCloud cloud = generate_points("uniform", 10, dim, 3);
    const PiecesVerdict verdict = tests::verify({}, dim, CloudParts(cloud));
    EXPECT_FALSE(verdict.valid);
    EXPECT_NE(verdict.reason, "");
  }
}

// A simplex of a piece, and one of another on the other side of a facet.
struct Seam {
  std::size_t piece, simplex, other_piece, other_simplex;
};

std::set<std::uint64_t> rows_of(const PieceMesh& piece, int dim, std::size_t simplex) {
  std::set<std::uint64_t> rows;
  for (int k = 0; k <= dim; ++k) {
    rows.insert(piece.points[piece.simplices[simplex * (dim + 1U) + static_cast<unsigned>(k)]].row);
  }
  return rows;
}

std::vector<Seam> seams(const Pieces& pieces, int dim) {
  std::map<std::set<std::uint64_t>, std::pair<std::size_t, std::size_t>> facets;
  std::vector<Seam> found;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (std::size_t s = 0; s < pieces[p].simplices.size() / (dim + 1U); ++s) {
      const auto rows = rows_of(pieces[p], dim, s);
      for (const std::uint64_t row : rows) {
        auto facet = rows;
        facet.erase(row);
        const auto [at, is_new] = facets.try_emplace(facet, p, s);
        if (!is_new && at->second.first != p) {
          found.push_back({at->second.first, at->second.second, p, s});
        }
      }
    }
  }
  return found;
}

std::uint32_t corner_with(PieceMesh& piece, const RowPoint& point) {
  for (std::uint32_t i = 0; i < piece.points.size(); ++i) {
    if (piece.points[i].row == point.row) return i;
  }
  piece.points.push_back(point);
  return static_cast<std::uint32_t>(piece.points.size() - 1);
}

RowPoint& corner(PieceMesh& piece, int dim, std::size_t simplex, int k) {
  return piece.points[piece.simplices[simplex * (dim + 1U) + static_cast<unsigned>(k)]];
}

void add_simplex(PieceMesh& piece, const std::vector<RowPoint>& corners) {
  for (const RowPoint& point : corners) piece.simplices.push_back(corner_with(piece, point));
}

void remove_simplex(PieceMesh& piece, int dim, std::size_t simplex) {
  const auto at = piece.simplices.begin() + static_cast<std::ptrdiff_t>(simplex * (dim + 1U));
  piece.simplices.erase(at, at + dim + 1);
}

// What triangulates the two simplices at a seam the other way: two triangles at the other diagonal,
// or three tetrahedra around the line between the opposite corners.
void flip(Pieces& pieces, int dim, const Seam& seam) {
  PieceMesh &first = pieces[seam.piece], &second = pieces[seam.other_piece];
  const auto rows = rows_of(second, dim, seam.other_simplex);
  std::vector<RowPoint> corners;
  for (int k = 0; k <= dim; ++k) corners.push_back(corner(first, dim, seam.simplex, k));
  RowPoint opposite;
  for (int k = 0; k <= dim; ++k) {
    const RowPoint& point = corner(second, dim, seam.other_simplex, k);
    if (!rows_of(first, dim, seam.simplex).contains(point.row)) opposite = point;
  }
  remove_simplex(first, dim, seam.simplex);
  remove_simplex(second, dim, seam.other_simplex);
  for (int k = 0; k <= dim; ++k) {
    if (!rows.contains(corners[static_cast<std::size_t>(k)].row)) continue;  // the other diagonal's
    std::vector<RowPoint> flipped = corners;
    flipped[static_cast<std::size_t>(k)] = opposite;
    add_simplex(k % 2 == 0 ? first : second, flipped);
  }
}

// Calls f for one copy of a vertex, or for all of them.
template <class F>
void for_copies(Pieces& pieces, std::uint64_t row, std::size_t piece, bool all, F&& f) {
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (RowPoint& point : pieces[p].points) {
      if (point.row == row && (all || p == piece)) f(point);
    }
  }
}

// Spoils a mesh at a seam, and says how.
std::string spoil(Pieces& pieces, int dim, std::size_t rows, Random& random) {
  const std::vector<Seam> all = seams(pieces, dim);
  const Seam seam = all[random() % all.size()];
  PieceMesh &first = pieces[seam.piece], &second = pieces[seam.other_piece];
  const int k = static_cast<int>(random() % (static_cast<unsigned>(dim) + 1));
  const std::uint64_t row = corner(first, dim, seam.simplex, k).row;
  const bool every_copy = random() % 2 == 0;
  switch (random() % 7) {
    case 0:
      flip(pieces, dim, seam);
      return "flipped";
    case 1:
      remove_simplex(first, dim, seam.simplex);
      return "missing";
    case 2: {
      std::vector<RowPoint> corners;
      for (int i = 0; i <= dim; ++i) corners.push_back(corner(first, dim, seam.simplex, i));
      add_simplex(every_copy ? first : second, corners);
      return every_copy ? "doubled in its piece" : "doubled in another piece";
    }
    case 3: {
      const std::uint64_t other = (row + 1 + random() % (rows - 1)) % rows;
      for_copies(pieces, row, seam.piece, every_copy, [&](RowPoint& p) { p.row = other; });
      return "wrong row";
    }
    case 4: {
      const std::uint64_t other = corner(first, dim, seam.simplex, (k + 1) % (dim + 1)).row;
      constexpr std::uint64_t kNone = ~std::uint64_t{0};
      for_copies(pieces, row, 0, true, [&](RowPoint& p) { p.row = kNone; });
      for_copies(pieces, other, 0, true, [&](RowPoint& p) { p.row = row; });
      for_copies(pieces, kNone, 0, true, [&](RowPoint& p) { p.row = other; });
      return "exchanged rows";
    }
    case 5: {
      const int axis = static_cast<int>(random() % static_cast<unsigned>(dim));
      const double up = random() % 2 == 0 ? 1e300 : -1e300;
      for_copies(pieces, row, seam.piece, every_copy,
                 [&](RowPoint& p) { p.position[axis] = std::nextafter(p.position[axis], up); });
      return "moved by the least";
    }
    default: {
      const glm::dvec3 to = corner(second, dim, seam.other_simplex, 0).position;
      const bool same = corner(second, dim, seam.other_simplex, 0).row == row;
      for_copies(pieces, row, seam.piece, every_copy, [&](RowPoint& p) {
        p.position = same ? p.position + 0.25 : (p.position + to) * 0.5;
      });
      return "moved";
    }
  }
}

TEST(VerifyPieces, FindsAThousandOfAThousandFaultsAtSeams) {
  int done = 0;
  std::map<std::string, int> kinds;
  for (int seed = 0; done < 1000; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const int dim = seed % 2 + 2;
    const char* const names[] = {"uniform", "grid", "cluster", "sphere"};
    PointCloud cloud = generate_points(names[seed / 2 % 4], dim == 2 ? 120 : 60, dim,
                                       static_cast<std::uint64_t>(seed));
    if (seed % 3 == 0) cloud = with_equal_points(cloud, random);
    const Pieces good = tests::in_pieces(cloud, dim, 2 + random() % 8);
    if (seams(good, dim).empty()) continue;
    for (int fault = 0; fault < 5; ++fault, ++done) {
      Pieces bad = good;
      const std::string what = spoil(bad, dim, cloud.size(), random);
      const PiecesVerdict verdict = tests::verify(bad, dim, SomeParts(cloud, 3));
      EXPECT_FALSE(verdict.canonical) << what << ", seed " << seed << ", fault " << fault;
      EXPECT_NE(verdict.reason, "") << what << ", seed " << seed;
      // Several ranks find it, and say the same.
      const int ranks = 2 + done % 4;
      EXPECT_EQ(tests::verify_by_ranks(ranks, bad, dim, SomeParts(cloud, 3)), verdict)
          << what << ", seed " << seed << ", fault " << fault << ", " << ranks << " ranks";
      ++kinds[what];
    }
  }
  EXPECT_EQ(kinds.size(), 8U);
}

TEST(VerifyPieces, NamesPieceAndSimplex) {
  const PointCloud cloud = generate_points("uniform", 300, 2, 1);
  Pieces pieces = tests::in_pieces(cloud, 2, 6);
  std::swap(pieces[3].simplices[30], pieces[3].simplices[31]);
  const PiecesVerdict verdict = tests::verify(pieces, 2, CloudParts(cloud));
  EXPECT_FALSE(verdict.valid);
  EXPECT_EQ(verdict.piece, 3U);
  EXPECT_EQ(verdict.simplex, 10U);
  EXPECT_EQ(verdict.reason, "it is oriented clockwise");
}

TEST(VerifyPieces, TellsOfPointsThatAreNoVertices) {
  const PointCloud cloud = generate_points("uniform", 300, 2, 1);
  PointCloud more = cloud;
  more.positions.emplace_back(0.5, 0.5, 0);
  const PiecesVerdict verdict = tests::verify(tests::in_pieces(cloud, 2, 4), 2, CloudParts(more));
  EXPECT_FALSE(verdict.valid);
  EXPECT_EQ(verdict.reason, "row 300 is in no triangle");
  PointCloud fewer = cloud;
  fewer.positions.pop_back();
  EXPECT_FALSE(tests::verify(tests::in_pieces(cloud, 2, 4), 2, CloudParts(fewer)).valid);
}

// Another of equal rows is a vertex: Delaunay, but not canonical.
TEST(VerifyPieces, DemandsTheLowestOfEqualRows) {
  PointCloud cloud = generate_points("uniform", 200, 2, 1);
  cloud.positions.push_back(cloud.positions[17]);
  Pieces pieces = tests::in_pieces(cloud, 2, 5);
  for_copies(pieces, 17, 0, true, [](RowPoint& point) { point.row = 200; });
  const PiecesVerdict verdict = tests::verify(pieces, 2, CloudParts(cloud));
  EXPECT_TRUE(verdict.delaunay) << verdict.reason;
  EXPECT_FALSE(verdict.canonical);
  EXPECT_EQ(verdict.reason, "row 200 is a vertex, but equals row 17");
}

TEST(VerifyPieces, ComparesHeights) {
  PointCloud cloud = generate_points("uniform", 200, 3, 1);
  Pieces pieces = tests::in_pieces(cloud, 2, 5);
  EXPECT_EQ(tests::verify(pieces, 2, CloudParts(cloud)).heights, "equal");
  for_copies(pieces, 5, 0, true, [](RowPoint& point) { point.position.z += 1e-9; });
  const PiecesVerdict verdict = tests::verify(pieces, 2, CloudParts(cloud));
  EXPECT_TRUE(verdict.canonical);
  EXPECT_EQ(verdict.heights, "different");
  EXPECT_NE(verdict.other_height.find("row 5 "), std::string::npos);
}

TEST(VerifyPieces, KeepsRowsAbove32Bits) {
  // Rows are counted by the parts: those of the mesh are far above them.
  const PointCloud cloud = generate_points("uniform", 100, 2, 1);
  Pieces pieces = tests::in_pieces(cloud, 2, 3);
  for (PieceMesh& piece : pieces) {
    for (RowPoint& point : piece.points) point.row += std::uint64_t{1} << 32;
  }
  const PiecesVerdict verdict = tests::verify(pieces, 2, CloudParts(cloud));
  EXPECT_FALSE(verdict.valid);
  EXPECT_NE(verdict.reason.find("is not a row of the points"), std::string::npos);
  EXPECT_TRUE(verdict.unknown_vertex);
}

TEST(VerifyPieces, TellsOfVerticesThatAreNoPoints) {
  const PointCloud cloud = generate_points("uniform", 300, 2, 1);
  Pieces pieces = tests::in_pieces(cloud, 2, 6);
  for_copies(pieces, 7, 0, true, [](RowPoint& point) { point.position.x += 1e-9; });
  const PiecesVerdict verdict = tests::verify(pieces, 2, CloudParts(cloud));
  EXPECT_FALSE(verdict.valid);
  EXPECT_TRUE(verdict.unknown_vertex) << verdict.reason;
  EXPECT_NE(verdict.reason.find("row 7 is at "), std::string::npos) << verdict.reason;
  EXPECT_EQ(tests::verify_by_ranks(4, pieces, 2, SomeParts(cloud, 7)), verdict);
}

// A copy of a vertex in another piece may not have a height of its own.
TEST(VerifyPieces, ComparesHeightsOfAllCopies) {
  const PointCloud cloud = generate_points("uniform", 200, 3, 1);
  Pieces pieces = tests::in_pieces(cloud, 2, 5);
  const Seam seam = seams(pieces, 2).front();
  const auto rows = rows_of(pieces[seam.piece], 2, seam.simplex);
  for (const std::uint64_t row : rows_of(pieces[seam.other_piece], 2, seam.other_simplex)) {
    if (!rows.contains(row)) continue;
    for_copies(pieces, row, seam.other_piece, false, [](RowPoint& p) { p.position.z += 1; });
    break;
  }
  const PiecesVerdict verdict = tests::verify(pieces, 2, CloudParts(cloud));
  EXPECT_EQ(verdict.heights, "different");
  EXPECT_EQ(tests::verify_by_ranks(3, pieces, 2, SomeParts(cloud, 2)), verdict);
}

// More ranks than pieces, and than parts of points.
TEST(VerifyPieces, TakesMoreRanksThanThereIsWork) {
  const PointCloud cloud = generate_points("gauss", 100, 3, 1);
  const Pieces pieces = tests::in_pieces(cloud, 3, 3);
  EXPECT_EQ(tests::verify_by_ranks(9, pieces, 3, CloudParts(cloud)),
            tests::verify(pieces, 3, CloudParts(cloud)));
}

PieceSource source_of(const Pieces& pieces, int dim) {
  PieceSource source{
      dim, pieces.size(), [&](std::size_t i, PieceMesh& mesh) { mesh = pieces[i]; }, {}};
  for (const PieceMesh& piece : pieces) {
    source.simplices.push_back(piece.simplices.size() / (static_cast<std::size_t>(dim) + 1));
  }
  return source;
}

TEST(VerifyPieces, FindsTheSameInRunsOfPieces) {
  for (const int dim : {2, 3}) {
    const PointCloud cloud = generate_points("uniform", 300, dim, 1);
    Pieces pieces = tests::in_pieces(cloud, dim, 3);
    for (const bool spoiled : {false, true}) {
      const std::size_t corner = 10 * (static_cast<std::size_t>(dim) + 1);  // of simplex 10
      if (spoiled) std::swap(pieces[1].simplices[corner], pieces[1].simplices[corner + 1]);
      const PiecesVerdict expected = tests::verify(pieces, dim, CloudParts(cloud));
      const PieceSource source = source_of(pieces, dim);
      for (const std::uint64_t most : {1U, 7U, 100U, 1000000U}) {
        SCOPED_TRACE(std::to_string(most) + " simplices in " + std::to_string(dim) + "D");
        internal::PieceRuns runs(source, most);
        EXPECT_EQ(runs.pieces().pieces == pieces.size(), most == 1000000);
        PiecesVerdict verdict = verify_pieces(runs.pieces(), CloudParts(cloud), "mesh");
        runs.name_in_source(verdict);
        if (!spoiled) {
          EXPECT_EQ(verdict, expected);
          continue;
        }
        EXPECT_FALSE(verdict.valid);
        EXPECT_EQ(verdict.piece, std::optional<std::size_t>(1));
        EXPECT_EQ(verdict.simplex, std::optional<std::size_t>(10));
        EXPECT_EQ(verdict.reason, expected.reason);
      }
    }
  }
}

TEST(VerifyPieces, RefusesPiecesThatMemoryDoesNotHold) {
  const PointCloud cloud = generate_points("uniform", 20000, 2, 1);
  const Pieces pieces = tests::in_pieces(cloud, 2, 1);
  for (const bool can_cut : {false, true}) {
    PieceSource source = source_of(pieces, 2);
    if (!can_cut) source.simplices.clear();
    try {
      verify_pieces(source, CloudParts(cloud), "mesh", files::MemoryBudget(1));
      ADD_FAILURE() << "accepted";
    } catch (const files::FileError& error) {
      EXPECT_EQ(error.cause(), files::Cause::memory);
      EXPECT_EQ(error.file(), "mesh");
      EXPECT_NE(error.place().find("a piece of "), std::string::npos) << error.what();
    }
  }
}

// Pieces that are all border, in less memory than they take.
TEST(VerifyPieces, BordersWaitOnDisk) {
  const PointCloud cloud = generate_points("uniform", 6000, 3, 1);
  const Pieces whole = tests::in_pieces(cloud, 3, 1);
  ASSERT_EQ(whole.size(), 1U);
  // Every fourth simplex, so that neighbours are hardly ever together.
  Pieces pieces(4, {whole[0].points, {}});
  for (std::size_t i = 0; i < whole[0].simplices.size(); ++i) {
    pieces[i / 4 % 4].simplices.push_back(whole[0].simplices[i]);
  }
  const PieceSource source = source_of(pieces, 3);
  const files::MemoryBudget memory(files::resident_set() + (std::uint64_t{24} << 20));
  // Two facets of each simplex at least: corners, rows, and the simplex.
  ASSERT_GT(whole[0].simplices.size() / 4 * 2 * 136, memory.limit() / 16);
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / ("borders-" + std::to_string(::getpid()));
  const auto verify_in = [&](int ranks) {
    PiecesVerdict first;
    comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
      const PiecesVerdict verdict =
          verify_pieces(communicator, source, CloudParts(cloud), {"mesh", memory, folder});
      if (communicator.rank() == 0) first = verdict;
    });
    return first;
  };
  try {
    verify_in(1);
    ADD_FAILURE() << "nothing was written";
  } catch (const files::FileError& error) {
    EXPECT_EQ(error.cause(), files::Cause::device) << error.what();
    EXPECT_NE(std::string(error.what()).find(folder.string()), std::string::npos) << error.what();
  }
  std::filesystem::create_directory(folder);
  const PiecesVerdict expected = tests::verify(pieces, 3, CloudParts(cloud));
  EXPECT_TRUE(expected.canonical) << expected.reason;
  for (const int ranks : {1, 2}) EXPECT_EQ(verify_in(ranks), expected);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  std::filesystem::remove(folder);
}

}  // namespace
}  // namespace delray::delaunay
