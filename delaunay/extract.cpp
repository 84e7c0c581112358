#include "delaunay/internal/extract.h"

#include <utility>

namespace delray::delaunay::internal {

Triangulation extract(Mesh<2>&& mesh, std::span<const std::uint32_t> rows) {
  Triangulation result;
  result.dim = 2;
  result.distinct = rows.size();
  std::size_t live = 0;
  for (SimplexNumber t = 0; t < mesh.size(); ++t) live += mesh.is_dead(t) ? 0 : 1;
  Array<VertexNumber> vertices = std::move(mesh).take_finite();
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = rows[vertices[i]];
  result.vertices.assign(vertices.data(), vertices.data() + vertices.size());
  // Of collinear points only ghosts are left, and those bound nothing.
  if (!result.vertices.empty()) result.hull_facets = live - result.size();
  return result;
}

}  // namespace delray::delaunay::internal
