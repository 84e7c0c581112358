// A run's points are numbered in the order in which its simplices name them. O(points + corners) of
// the piece for each run.
#include "delaunay/verify/piece_runs.h"

#include <algorithm>

namespace delray::delaunay::internal {

PieceRuns::PieceRuns(const PieceSource& source, std::uint64_t most) : source_(source) {
  for (std::size_t piece = 0; piece < source.pieces; ++piece) {
    const std::uint64_t simplices = source.simplices.empty() ? 0 : source.simplices[piece];
    if (simplices <= most) {
      runs_.push_back({piece});
      continue;
    }
    const std::uint64_t runs = (simplices + most - 1) / most;
    for (std::uint64_t i = 0; i < runs; ++i) {
      runs_.push_back({piece, simplices / runs * i + std::min(i, simplices % runs),
                       simplices / runs * (i + 1) + std::min(i + 1, simplices % runs)});
    }
  }
  pieces_ = {source.dim,
             runs_.size(),
             [this](std::size_t run, PieceMesh& mesh) { read(runs_[run], mesh); },
             {}};
}

void PieceRuns::read(const Run& run, PieceMesh& mesh) {
  if (run.last == Run{}.last) {
    whole_ = {};
    held_ = source_.pieces;
    source_.read(run.piece, mesh);
    return;
  }
  if (held_ != run.piece) {
    held_ = source_.pieces;  // nothing, should reading fail
    source_.read(run.piece, whole_);
    held_ = run.piece;
  }
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  const auto corners = static_cast<std::uint64_t>(source_.dim) + 1;
  std::vector<std::uint32_t> numbers(whole_.points.size(), kNone);
  mesh.points.clear();
  mesh.simplices.clear();
  mesh.simplices.reserve((run.last - run.first) * corners);
  for (std::uint64_t i = run.first * corners; i < run.last * corners; ++i) {
    const std::uint32_t corner = whole_.simplices[i];
    if (numbers[corner] == kNone) {
      numbers[corner] = static_cast<std::uint32_t>(mesh.points.size());
      mesh.points.push_back(whole_.points[corner]);
    }
    mesh.simplices.push_back(numbers[corner]);
  }
}

void PieceRuns::name_in_source(PiecesVerdict& verdict) const {
  if (!verdict.piece) return;
  const Run& run = runs_[*verdict.piece];
  verdict.piece = run.piece;
  if (verdict.simplex) *verdict.simplex += run.first;
}

}  // namespace delray::delaunay::internal
