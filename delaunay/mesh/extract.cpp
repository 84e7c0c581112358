// Copies the live finite simplices of a mesh piece by piece and returns the memory of each piece to
// the system as soon as it is copied. Threads pack pieces at the same time and append them in
// order, so the result does not depend on their number.
#include "delaunay/mesh/extract.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "delaunay/mesh/array.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay::internal {

namespace {

// Simplices whose memory goes back at once: whole huge pages, which take long to split.
template <int D>
constexpr std::size_t kPiece = std::size_t{1} << (D == 2 ? 18 : 16);

}  // namespace

// Piece by piece, so that the mesh goes as the result comes, and in order, so that the result does
// not depend on the number of threads.
template <int D>
Result extract(Mesh<D>&& mesh, std::span<const std::uint32_t> rows, int threads,
               std::vector<std::uint16_t> created_by) {
  constexpr std::size_t kCorners = Mesh<D>::kCorners;
  Mesh<D> own = std::move(mesh);
  Result whole;
  Triangulation& result = whole.triangulation;
  result.dim = D;
  result.distinct = rows.size();
  result.vertices.reserve(kCorners * own.size());
  prefer_huge_pages(result.vertices.data(), kCorners * own.size() * sizeof(VertexNumber));

  std::size_t ghosts = 0, made = 0;
  std::atomic<std::size_t> next_taken = 0, next_appended = 0;
  const std::size_t pieces = (own.size() + kPiece<D> - 1) / kPiece<D>;
  const auto work = [&] {
    Array<VertexNumber> packed(kCorners * std::min(kPiece<D>, own.size()));
    std::vector<std::uint16_t> own_created_by;
    for (std::size_t piece; (piece = next_taken++) < pieces;) {
      const std::size_t first = piece * kPiece<D>, last = std::min(own.size(), first + kPiece<D>);
      std::size_t count = 0, own_ghosts = 0;
      for (auto simplex = static_cast<SimplexNumber>(first); simplex < last; ++simplex) {
        if (own.is_dead(simplex)) continue;
        if (own.is_ghost(simplex)) {
          ++own_ghosts;
          continue;
        }
        for (unsigned k = 0; k < kCorners; ++k) packed[count++] = rows[own.vertex(simplex, k)];
        if (!created_by.empty()) own_created_by.push_back(created_by[simplex]);
      }
      own.discard(first, last);
      // Pieces are taken in order, so whoever has the one before is at work on it.
      for (std::size_t i; (i = next_appended) != piece;) next_appended.wait(i);
      result.vertices.insert(result.vertices.end(), packed.data(), packed.data() + count);
      if (!created_by.empty()) {
        // Their slots are those of this piece and of pieces before it, which nobody reads any more.
        std::ranges::copy(own_created_by, created_by.begin() + static_cast<std::ptrdiff_t>(made));
        made += own_created_by.size();
        own_created_by.clear();
      }
      ghosts += own_ghosts;
      ++next_appended;
      next_appended.notify_all();
    }
  };
  const auto workers = std::min(static_cast<std::size_t>(std::max(threads, 1)), pieces);
  if (workers <= 1) {
    work();
  } else {
    parallel::parallel_for(0, workers, 1, [&](std::size_t) { work(); });
  }
  // Collinear points leave only ghosts, and those bound nothing.
  if (!result.vertices.empty()) result.hull_facets = ghosts;
  created_by.resize(made);
  whole.created_by = std::move(created_by);
  return whole;
}

template Result extract(Mesh<2>&& mesh, std::span<const std::uint32_t> rows, int threads,
                        std::vector<std::uint16_t> created_by);
template Result extract(Mesh<3>&& mesh, std::span<const std::uint32_t> rows, int threads,
                        std::vector<std::uint16_t> created_by);

}  // namespace delray::delaunay::internal
