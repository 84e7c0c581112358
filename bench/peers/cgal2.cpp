// Converts points to CGAL's own type before the clock starts, and times the insertion alone. For
// comparisons of results, equal points are reduced to the lowest row first, and finite faces are
// read back as rows of the input.
#include "bench/peers/cgal2.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

namespace delray::bench {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

double seconds_of_cgal2(std::span<const glm::dvec3> points) {
  std::vector<Kernel::Point_2> input;
  input.reserve(points.size());
  for (const glm::dvec3& p : points) input.emplace_back(p.x, p.y);
  CGAL::Delaunay_triangulation_2<Kernel> triangulation;
  const auto start = std::chrono::steady_clock::now();
  triangulation.insert(input.begin(), input.end());
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

delaunay::Triangulation triangulate_with_cgal2(std::span<const glm::dvec3> points) {
  using Vertex = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
  using Structure = CGAL::Triangulation_data_structure_2<Vertex>;
  // Of equal points CGAL would keep any; the lowest row is to represent them.
  std::vector<std::pair<Kernel::Point_2, std::uint32_t>> input;
  input.reserve(points.size());
  for (std::uint32_t row = 0; row < points.size(); ++row) {
    input.emplace_back(Kernel::Point_2(points[row].x, points[row].y), row);
  }
  std::stable_sort(input.begin(), input.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  input.erase(std::unique(input.begin(), input.end(),
                          [](const auto& a, const auto& b) { return a.first == b.first; }),
              input.end());
  CGAL::Delaunay_triangulation_2<Kernel, Structure> triangulation;
  triangulation.insert(input.begin(), input.end());
  delaunay::Triangulation result;
  result.distinct = triangulation.number_of_vertices();
  if (triangulation.dimension() < 2) return result;
  for (const auto& face : triangulation.finite_face_handles()) {
    for (int k = 0; k < 3; ++k) result.vertices.push_back(face->vertex(k)->info());
  }
  auto face = triangulation.incident_faces(triangulation.infinite_vertex());
  const auto first = face;
  do ++result.hull_facets;
  while (++face != first);
  return result;
}

}  // namespace delray::bench
