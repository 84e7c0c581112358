// Pieces of a mesh in memory, as tests make and spoil them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <vector>

#include "comm/threads.h"
#include "delaunay/mesh_folder.h"
#include "delaunay/triangulate.h"
#include "delaunay/triangulation_pieces.h"
#include "delaunay/verify_pieces.h"

namespace delray::tests {

// Keeps the pieces that it is given, by their tiles.
class PiecesInMemory : public delaunay::TileSink {
 public:
  void take(const delaunay::TilePiece& piece) override {
    const std::lock_guard lock(mutex_);
    by_tile_[piece.tile].push_back({{piece.points.begin(), piece.points.end()},
                                    {piece.simplices.begin(), piece.simplices.end()}});
  }
  std::vector<delaunay::PieceMesh> all() const {
    std::vector<delaunay::PieceMesh> pieces;
    for (const auto& [tile, some] : by_tile_) pieces.insert(pieces.end(), some.begin(), some.end());
    return pieces;
  }

 private:
  std::mutex mutex_;
  std::map<std::uint64_t, std::vector<delaunay::PieceMesh>> by_tile_;
};

// The triangulation of points in about as many pieces.
inline std::vector<delaunay::PieceMesh> in_pieces(const delaunay::PointCloud& cloud, int dim,
                                                  std::size_t pieces) {
  delaunay::Options options;
  options.dim = dim;
  const auto points = delaunay::view(cloud.positions);
  const delaunay::Triangulation whole = delaunay::triangulate(points, options).triangulation;
  PiecesInMemory sink;
  delaunay::give_pieces(points, whole, std::max<std::size_t>(1, whole.size() / pieces), sink);
  return sink.all();
}

inline delaunay::PiecesVerdict verify(const std::vector<delaunay::PieceMesh>& pieces, int dim,
                                      const delaunay::PointParts& points) {
  const delaunay::PieceSource source{
      dim, pieces.size(), [&](std::size_t i, delaunay::PieceMesh& mesh) { mesh = pieces[i]; }};
  return delaunay::verify_pieces(source, points, "mesh", files::MemoryBudget::unlimited());
}

// As above, by several ranks, which must all find the same.
inline delaunay::PiecesVerdict verify_by_ranks(int ranks,
                                               const std::vector<delaunay::PieceMesh>& pieces,
                                               int dim, const delaunay::PointParts& points) {
  const delaunay::PieceSource source{
      dim, pieces.size(), [&](std::size_t i, delaunay::PieceMesh& mesh) { mesh = pieces[i]; }};
  const delaunay::VerifyPiecesOptions options{"mesh", files::MemoryBudget::unlimited(), {}};
  std::vector<delaunay::PiecesVerdict> verdicts(static_cast<std::size_t>(ranks));
  comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
    verdicts[static_cast<std::size_t>(communicator.rank())] =
        delaunay::verify_pieces(communicator, source, points, options);
  });
  for (const delaunay::PiecesVerdict& each : verdicts) EXPECT_EQ(each, verdicts[0]);
  return verdicts[0];
}

}  // namespace delray::tests
