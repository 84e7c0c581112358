// Asks the method for its mesh, or matches the facets of its simplices.
#include "delaunay/mesh/build_mesh.h"

#include <numeric>
#include <stdexcept>
#include <string>

#include "delaunay/mesh/facets.h"
#include "delaunay/methods.h"

namespace delray::delaunay {

template <int D>
BuiltMesh<D> mesh_of(const Triangulation& triangulation, std::size_t points) {
  constexpr unsigned kCorners = D + 1;
  const FacetMates mates = match_facets(D, triangulation.vertices, points);
  BuiltMesh<D> built;
  const std::size_t finite = triangulation.size();
  Mesh<D>& mesh = built.mesh = Mesh<D>(finite + triangulation.hull_facets);
  auto ghost = static_cast<SimplexNumber>(finite);
  const auto place = [&](std::size_t facet) {
    return corner_of(static_cast<SimplexNumber>(facet / kCorners),
                     static_cast<unsigned>(facet % kCorners));
  };
  for (std::size_t facet = 0; facet < triangulation.vertices.size(); ++facet) {
    mesh.set_vertex(place(facet), triangulation.vertices[facet]);
    if (mates.mates[facet] != FacetMates::kNone) {
      mesh.set_neighbour(place(facet), place(mates.mates[facet]));
      continue;
    }
    const std::size_t first = facet / kCorners * kCorners;
    const std::span<const int> order = facet_corners(D, facet % kCorners);
    for (unsigned k = 0; k < kCorners; ++k) {
      mesh.set_vertex(ghost, k, k < D ? triangulation.vertices[first + order[k]] : kInfiniteVertex);
      mesh.set_neighbour(ghost, k, corner_of(ghost, k));
    }
    mesh.link(corner_of(ghost++, D), place(facet));
  }
  built.rows = Array<std::uint32_t>(points);
  std::iota(built.rows.data(), built.rows.data() + points, 0U);
  built.distinct = triangulation.distinct;
  return built;
}

template <int D>
BuiltMesh<D> build_mesh(PointView<double> points, const Options& options) {
  const Options resolved = resolve(options);
  if (points.size() > kMaximumSimplices / 2) {
    throw std::invalid_argument("a tile of " + std::to_string(points.size()) +
                                " points, which are more than 2^29");
  }
  const Method& method = method_of(resolved);
  if constexpr (D == 2) {
    if (method.mesh_2d != nullptr) return method.mesh_2d(points, resolved);
  } else {
    if (method.mesh_3d != nullptr) return method.mesh_3d(points, resolved);
  }
  return mesh_of<D>(method.triangulate(points, resolved).triangulation, points.size());
}

template BuiltMesh<2> build_mesh(PointView<double> points, const Options& options);
template BuiltMesh<3> build_mesh(PointView<double> points, const Options& options);

template BuiltMesh<2> mesh_of(const Triangulation& triangulation, std::size_t points);
template BuiltMesh<3> mesh_of(const Triangulation& triangulation, std::size_t points);

}  // namespace delray::delaunay
