// Converts points to CGAL's own type before the clock starts, and times insertion, constraints and
// refinement.
#include "bench/peers/cgal_mesher.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace delray::bench {

MesherRun refine_with_cgal(const delaunay::Outline& outline, double min_angle) {
  using MesherKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Structure =
      CGAL::Triangulation_data_structure_2<CGAL::Delaunay_mesh_vertex_base_2<MesherKernel>,
                                           CGAL::Delaunay_mesh_face_base_2<MesherKernel>>;
  using Constrained = CGAL::Constrained_Delaunay_triangulation_2<MesherKernel, Structure>;
  using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Constrained>;
  using Point = MesherKernel::Point_2;
  std::vector<Point> points, seeds;
  for (const glm::dvec3& p : outline.points.positions) points.emplace_back(p.x, p.y);
  for (const glm::dvec2& p : outline.holes) seeds.emplace_back(p.x, p.y);
  std::vector<std::pair<Point, Point>> segments;
  for (const auto& [a, b] : outline.segments) segments.emplace_back(points[a], points[b]);
  const double sine = std::sin(min_angle * (std::numbers::pi / 180));

  const auto start = std::chrono::steady_clock::now();
  Constrained triangulation;
  triangulation.insert(points.begin(), points.end());
  if (segments.empty()) {
    auto face = triangulation.incident_faces(triangulation.infinite_vertex());
    const auto first = face;
    std::vector<std::pair<Constrained::Vertex_handle, Constrained::Vertex_handle>> hull;
    do {
      const int infinite = face->index(triangulation.infinite_vertex());
      hull.emplace_back(face->vertex(Constrained::ccw(infinite)),
                        face->vertex(Constrained::cw(infinite)));
    } while (++face != first);
    for (const auto& [a, b] : hull) triangulation.insert_constraint(a, b);
  } else {
    for (const auto& [a, b] : segments) triangulation.insert_constraint(a, b);
  }
  CGAL::Delaunay_mesher_2<Constrained, Criteria> mesher(triangulation);
  mesher.set_criteria(Criteria(sine * sine, 0));
  mesher.set_seeds(seeds.begin(), seeds.end());
  mesher.refine_mesh();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          triangulation.number_of_vertices()};
}

}  // namespace delray::bench
