#include "delaunay/internal/extract.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "delaunay/array.h"
#include "delaunay/internal/blocks.h"

namespace delray::delaunay::internal {

template <int D>
Triangulation extract(Mesh<D>&& mesh, std::span<const std::uint32_t> rows, int threads) {
  Mesh<D> own = std::move(mesh);
  const Blocks blocks(own.size(), threads);
  std::vector<typename Mesh<D>::Packed> packed(blocks.count());
  blocks.for_each([&](std::size_t block, std::size_t first, std::size_t last) {
    packed[block] = own.pack_finite(first, last);
    for (VertexNumber& vertex : packed[block].vertices) vertex = rows[vertex];
  });
  std::vector<std::size_t> begin = {0};
  std::size_t ghosts = 0;
  for (const auto& part : packed) {
    begin.push_back(begin.back() + part.vertices.size());
    ghosts += part.ghosts;
  }

  Triangulation result;
  result.dim = D;
  result.distinct = rows.size();
  result.vertices.reserve(begin.back());
  prefer_huge_pages(result.vertices.data(), begin.back() * sizeof(VertexNumber));
  if (blocks.count() == 1) {
    result.vertices.assign(packed[0].vertices.begin(), packed[0].vertices.end());
  } else {
    result.vertices.resize(begin.back());
    blocks.for_each([&](std::size_t block, std::size_t, std::size_t) {
      std::ranges::copy(packed[block].vertices, result.vertices.data() + begin[block]);
    });
  }
  // Of collinear points only ghosts are left, and those bound nothing.
  if (!result.vertices.empty()) result.hull_facets = ghosts;
  return result;
}

template Triangulation extract(Mesh<2>&& mesh, std::span<const std::uint32_t> rows, int threads);
template Triangulation extract(Mesh<3>&& mesh, std::span<const std::uint32_t> rows, int threads);

}  // namespace delray::delaunay::internal
