// Converts points to CGAL's own type before the clock starts, and times the insertion alone,
// sequential or, where CGAL is linked with oneTBB, parallel. For comparisons of results, equal
// points are reduced to the lowest row first, and finite cells are read back as rows of the input.
#include "bench/peers/cgal3.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#ifdef CGAL_LINKED_WITH_TBB
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

namespace delray::bench {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

static std::vector<Kernel::Point_3> convert(std::span<const glm::dvec3> points) {
  std::vector<Kernel::Point_3> input;
  input.reserve(points.size());
  for (const glm::dvec3& p : points) input.emplace_back(p.x, p.y, p.z);
  return input;
}

double seconds_of_cgal3(std::span<const glm::dvec3> points) {
  const std::vector<Kernel::Point_3> input = convert(points);
  CGAL::Delaunay_triangulation_3<Kernel> triangulation;
  const auto start = std::chrono::steady_clock::now();
  triangulation.insert(input.begin(), input.end());
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

#ifdef CGAL_LINKED_WITH_TBB
double seconds_of_parallel_cgal3(std::span<const glm::dvec3> points, int threads) {
  using Structure =
      CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_3<Kernel>,
                                           CGAL::Delaunay_triangulation_cell_base_3<Kernel>,
                                           CGAL::Parallel_tag>;
  using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Structure>;
  const std::vector<Kernel::Point_3> input = convert(points);
  CGAL::Bbox_3 box;
  for (const auto& p : input) box += p.bbox();
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  constexpr int kLocksPerAxis = 50;  // as in CGAL's example
  const auto start = std::chrono::steady_clock::now();
  Triangulation::Lock_data_structure locks(box, kLocksPerAxis);
  const Triangulation triangulation(input.begin(), input.end(), &locks);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
#endif

delaunay::Triangulation triangulate_with_cgal3(std::span<const glm::dvec3> points) {
  using Vertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
  using Cell = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
  using Structure = CGAL::Triangulation_data_structure_3<Vertex, Cell>;
  // Of equal points CGAL would keep any; the lowest row is to represent them.
  std::vector<std::pair<Kernel::Point_3, std::uint32_t>> input;
  input.reserve(points.size());
  for (std::uint32_t row = 0; row < points.size(); ++row) {
    input.emplace_back(Kernel::Point_3(points[row].x, points[row].y, points[row].z), row);
  }
  std::stable_sort(input.begin(), input.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  input.erase(std::unique(input.begin(), input.end(),
                          [](const auto& a, const auto& b) { return a.first == b.first; }),
              input.end());
  CGAL::Delaunay_triangulation_3<Kernel, Structure> triangulation;
  triangulation.insert(input.begin(), input.end());
  delaunay::Triangulation result;
  result.dim = 3;
  result.distinct = triangulation.number_of_vertices();
  if (triangulation.dimension() < 3) return result;
  for (const auto& cell : triangulation.finite_cell_handles()) {
    for (int k = 0; k < 4; ++k) result.vertices.push_back(cell->vertex(k)->info());
  }
  result.hull_facets = triangulation.number_of_cells() - triangulation.number_of_finite_cells();
  return result;
}

}  // namespace delray::bench
