#include "delaunay/internal/extract.h"

namespace delray::delaunay::internal {

Triangulation extract(Mesh<2>&& mesh, std::span<const std::uint32_t> rows) {
  Triangulation result;
  result.dim = 2;
  result.distinct = rows.size();
  const auto size = static_cast<SimplexNumber>(mesh.size());
  std::size_t finite = 0, ghosts = 0;
  for (SimplexNumber t = 0; t < size; ++t) {
    if (mesh.is_dead(t)) continue;
    ++(mesh.is_ghost(t) ? ghosts : finite);
  }
  // Of collinear points only ghosts are left, and those bound nothing.
  if (finite == 0) return result;
  result.hull_facets = ghosts;
  result.vertices.resize(3 * finite);
  std::size_t next = 0;
  for (SimplexNumber t = 0; t < size; ++t) {
    if (mesh.is_dead(t) || mesh.is_ghost(t)) continue;
    for (unsigned k = 0; k < 3; ++k) {
      result.vertices[next++] = rows[mesh.vertex(corner_of(t, k))];
    }
  }
  return result;
}

}  // namespace delray::delaunay::internal
