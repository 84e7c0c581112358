// The triangulation of the points, its segments made edges, its domain found, its pieces and
// triangles cut; then the triangles as rows. Ranks cut, rank 0 does the rest.
#include "delaunay/refine.h"

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "delaunay/insertion/walk.h"
#include "delaunay/interpolate.h"
#include "delaunay/mesh/arguments.h"
#include "delaunay/mesh/build_mesh.h"
#include "delaunay/mesh/equal_points.h"
#include "delaunay/refinement/make_delaunay.h"
#include "delaunay/refinement/recover_segments.h"
#include "delaunay/refinement/refinement_runs.h"
#include "delaunay/refinement/small_corners.h"

namespace delray::delaunay {
namespace {

using internal::RefinementMesh;
using internal::SegmentEnds;

// Products of four coordinates neither overflow nor, of those that count, underflow.
constexpr double kLargestCoordinate = 0x1p200, kLeastExtent = 0x1p-200;
constexpr std::size_t kMostVertices = kMaximumSimplices / 2 - 2;

void check(const Outline& outline, const RefineOptions& options) {
  if (!(options.min_angle >= 0 && options.min_angle <= kLargestMinAngle)) {
    throw std::invalid_argument("the smallest angle is 0 to " +
                                std::to_string(static_cast<int>(kLargestMinAngle)) + " degrees");
  }
  if (!(options.max_area >= 0)) throw std::invalid_argument("the largest area is not negative");
  double largest = 0;
  for (std::size_t row = 0; row < outline.points.size(); ++row) {
    const glm::dvec3& p = outline.points.positions[row];
    for (const double coordinate : {p.x, p.y}) {
      largest = std::max(largest, std::abs(coordinate));
      if (std::abs(coordinate) < kLargestCoordinate) continue;
      throw std::invalid_argument("row " + std::to_string(row) +
                                  " has a coordinate that is not finite or above 1e60");
    }
  }
  if (largest > 0 && largest < kLeastExtent) {
    throw std::invalid_argument("all coordinates are below 1e-60");
  }
  for (std::size_t i = 0; i < outline.holes.size(); ++i) {
    if (std::isfinite(outline.holes[i].x) && std::isfinite(outline.holes[i].y)) continue;
    throw std::invalid_argument("hole " + std::to_string(i) + " is not finite");
  }
  for (const auto& segment : outline.segments) {
    for (const std::uint32_t row : segment) {
      if (row >= outline.points.size()) {
        throw std::invalid_argument("a segment joins row " + std::to_string(row) +
                                    ", which is not there");
      }
    }
  }
}

std::size_t most_vertices(const RefineOptions& options) {
  return options.max_points == 0 ? kMostVertices : std::min(options.max_points, kMostVertices);
}

// Whether all points are on one line.
bool is_flat(const Mesh<2>& mesh) {
  for (SimplexNumber t = 0; t < mesh.size(); ++t) {
    if (!mesh.is_dead(t) && !mesh.is_ghost(t)) return false;
  }
  return true;
}

// A refinement under way.
struct Task {
  const Outline& outline;
  const RefineOptions& options;
  RefinementMesh mesh;
  std::vector<std::uint32_t> rows;  // of the vertices that the input has
  RefineCounts counts;
  std::optional<Triangulation> given;  // where there are heights
  std::vector<SmallCorner> corners;    // by vertices
};

void take_mesh(Task& task, BuiltMesh<2>&& built) {
  RefinementMesh& mesh = task.mesh;
  mesh.triangles = static_cast<SimplexNumber>(built.mesh.size());
  mesh.mesh = std::move(built.mesh);
  task.rows.assign(built.rows.data(), built.rows.data() + built.rows.size());
  mesh.reserve(task.rows.size());
  mesh.vertices = static_cast<VertexNumber>(task.rows.size());
  double largest = 0;
  for (VertexNumber v = 0; v < mesh.vertices; ++v) {
    const glm::dvec3& p = task.outline.points.positions[task.rows[v]];
    mesh.points[v] = {p.x + 0.0, p.y + 0.0};
    mesh.ends[v] = internal::kOnNoSegment;
    mesh.acute[v] = 0;
    largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  }
  for (SimplexNumber t = 0; t < mesh.triangles; ++t) mesh.set_marks(t, 0);
  constexpr double kUnits = 64;  // of rounding
  mesh.tolerance = kUnits * 0x1p-53 * largest;
}

// Those of the outline, or the edges of the hull.
std::vector<SegmentEnds> segments_of(const Task& task) {
  std::vector<SegmentEnds> segments;
  const RefinementMesh& mesh = task.mesh;
  if (task.outline.segments.empty()) {
    for (SimplexNumber t = 0; t < mesh.triangles; ++t) {
      if (mesh.mesh.is_dead(t)) continue;
      for (unsigned k = 0; k < 3; ++k) {
        const CornerNumber corner = corner_of(t, k);
        if (mesh.mesh.vertex(corner) != kInfiniteVertex) continue;
        segments.push_back(
            {mesh.mesh.vertex(next_corner(corner)), mesh.mesh.vertex(previous_corner(corner))});
      }
    }
    return segments;
  }
  const std::vector<std::uint32_t> lowest =
      lowest_equal_rows(view(task.outline.points.positions), 2);
  std::vector<VertexNumber> vertex_of(lowest.size());
  for (VertexNumber v = 0; v < task.rows.size(); ++v) vertex_of[task.rows[v]] = v;
  for (const auto& [a, b] : task.outline.segments) {
    segments.push_back({vertex_of[lowest[a]], vertex_of[lowest[b]]});
  }
  return segments;
}

// Takes what can be reached from the triangles, not over segments, out of the domain.
void take_out(RefinementMesh& mesh, std::vector<SimplexNumber> reached) {
  const auto take = [&](SimplexNumber t) {
    mesh.set_marks(t, static_cast<std::uint8_t>(mesh.marks(t) & ~RefinementMesh::kInside));
  };
  for (const SimplexNumber t : reached) take(t);
  while (!reached.empty()) {
    const SimplexNumber t = reached.back();
    reached.pop_back();
    for (unsigned k = 0; k < 3; ++k) {
      const CornerNumber corner = corner_of(t, k);
      const SimplexNumber next = simplex_of(mesh.mesh.neighbour(corner));
      if (mesh.is_segment(corner) || !mesh.is_inside(next)) continue;
      take(next);
      reached.push_back(next);
    }
  }
}

void find_domain(Task& task) {
  RefinementMesh& mesh = task.mesh;
  std::vector<SimplexNumber> outside;
  SimplexNumber finite = 0;
  for (SimplexNumber t = 0; t < mesh.triangles; ++t) {
    if (mesh.mesh.is_dead(t)) continue;
    mesh.set_marks(t, static_cast<std::uint8_t>(mesh.marks(t) | RefinementMesh::kInside));
    if (mesh.mesh.is_ghost(t)) {
      outside.push_back(t);
    } else {
      finite = t;
    }
  }
  take_out(mesh, std::move(outside));
  std::uint32_t random = 1;
  for (const glm::dvec2& hole : task.outline.holes) {
    const Place place = walk(mesh.mesh, mesh.places(), finite, hole, random);
    if (mesh.is_inside(place.simplex)) take_out(mesh, {place.simplex});
  }
  for (SimplexNumber t = 0; t < mesh.triangles; ++t) {
    if (!mesh.mesh.is_dead(t) && mesh.is_inside(t)) return;
  }
  throw std::invalid_argument("the segments enclose nothing");
}

// Throws std::length_error if triangles of the domain are to be so small that all vertices there
// may be are too few for them, before most of these are made.
void check_area(const RefinementMesh& mesh, const RefineOptions& options) {
  if (options.max_area <= 0) return;
  double area = 0;
  for (SimplexNumber t = 0; t < mesh.triangles; ++t) {
    if (mesh.mesh.is_dead(t) || !mesh.is_inside(t)) continue;
    const glm::dvec2& a = mesh.points[mesh.mesh.vertex(t, 0)];
    const glm::dvec2 b = mesh.points[mesh.mesh.vertex(t, 1)] - a,
                     c = mesh.points[mesh.mesh.vertex(t, 2)] - a;
    area += (b.x * c.y - b.y * c.x) / 2;
  }
  // There are fewer than two triangles for each vertex. A little less, for rounding.
  constexpr double kTriangles = 2 * (1 + 0x1p-20);
  const std::size_t most = most_vertices(options);
  if (area / options.max_area > kTriangles * static_cast<double>(most)) {
    throw std::length_error("triangles of so small an area take more than " + std::to_string(most) +
                            " points");
  }
}

std::uint32_t row_of(const Task& task, VertexNumber v) {
  const auto given = static_cast<VertexNumber>(task.rows.size());
  return v < given ? task.rows[v]
                   : static_cast<std::uint32_t>(task.outline.points.size() + (v - given));
}

// Heights of the added points: along segments between their ends, else of the given triangulation.
void add_heights(const Task& task, Refined& refined) {
  const RefinementMesh& mesh = task.mesh;
  const std::size_t n = task.outline.points.size();
  std::vector<double> heights(n);
  for (std::size_t row = 0; row < n; ++row) heights[row] = refined.points[row].z;
  const Query query(view(task.outline.points.positions), *task.given);
  const auto is_on_segment = [&](VertexNumber v) { return mesh.ends[v] != internal::kOnNoSegment; };
  const auto first = static_cast<VertexNumber>(task.rows.size());
  for (VertexNumber v = first; v < mesh.vertices; ++v) {
    glm::dvec3& p = refined.points[row_of(task, v)];
    if (!is_on_segment(v)) p.z = interpolate_linear(query, heights, p).value_or(0);
  }
  // Ends of segments have theirs now.
  for (VertexNumber v = first; v < mesh.vertices; ++v) {
    if (!is_on_segment(v)) continue;
    glm::dvec3& p = refined.points[row_of(task, v)];
    const glm::dvec3& a = refined.points[row_of(task, mesh.ends[v][0])];
    const glm::dvec3& b = refined.points[row_of(task, mesh.ends[v][1])];
    const double length = glm::length(glm::dvec2(b) - glm::dvec2(a));
    p.z = a.z + glm::length(glm::dvec2(p) - glm::dvec2(a)) / length * (b.z - a.z);
  }
}

Refined result_of(Task& task) {
  RefinementMesh& mesh = task.mesh;
  Refined refined;
  refined.points = task.outline.points.positions;
  for (auto v = static_cast<VertexNumber>(task.rows.size()); v < mesh.vertices; ++v) {
    refined.points.emplace_back(mesh.points[v], 0);
  }
  Triangulation& result = refined.triangulation;
  result.distinct = mesh.vertices;
  result.vertices.reserve(std::size_t{3} * mesh.triangles);
  refined.inside.reserve(mesh.triangles);
  for (SimplexNumber t = 0; t < mesh.triangles; ++t) {
    if (mesh.mesh.is_dead(t)) continue;
    for (unsigned k = 0; k < 3; ++k) {
      const CornerNumber corner = corner_of(t, k);
      if (!mesh.is_segment(corner) || corner > mesh.mesh.neighbour(corner)) continue;
      refined.segments.push_back({row_of(task, mesh.mesh.vertex(next_corner(corner))),
                                  row_of(task, mesh.mesh.vertex(previous_corner(corner)))});
    }
    if (mesh.mesh.is_ghost(t)) {
      ++result.hull_facets;
      continue;
    }
    for (unsigned k = 0; k < 3; ++k)
      result.vertices.push_back(row_of(task, mesh.mesh.vertex(t, k)));
    refined.inside.push_back(mesh.is_inside(t) ? 1 : 0);
  }
  return refined;
}

// Triangles of the domain that are below the bound.
std::uint64_t count_excepted(const RefinementMesh& mesh, const internal::TriangleBounds& bounds) {
  std::uint64_t count = 0;
  for (SimplexNumber t = 0; t < mesh.triangles; ++t) {
    if (mesh.mesh.is_dead(t) || !mesh.is_inside(t)) continue;
    const glm::dvec2 &a = mesh.points[mesh.mesh.vertex(t, 0)],
                     &b = mesh.points[mesh.mesh.vertex(t, 1)],
                     &c = mesh.points[mesh.mesh.vertex(t, 2)];
    if (bounds.is_skinny(internal::shape_of_triangle(a, b, c))) ++count;
  }
  return count;
}

internal::RefinementLimits limits_of(const RefineOptions& options) {
  return {options.threads, most_vertices(options), options.progress};
}

// Everything before triangles are cut. False if there are none.
bool prepare(Task& task) {
  Options how;
  how.threads = task.options.threads;
  BuiltMesh<2> built = build_mesh<2>(view(task.outline.points.positions), how);
  if (is_flat(built.mesh)) {
    task.mesh.vertices = static_cast<VertexNumber>(built.distinct);
    return false;
  }
  take_mesh(task, std::move(built));
  if (task.outline.points.has_z) task.given = result_of(task).triangulation;
  recover_segments(task.mesh, segments_of(task), limits_of(task.options), task.counts);
  task.corners = internal::find_small_corners(task.mesh);
  find_domain(task);
  check_area(task.mesh, task.options);
  return true;
}

Refined flat_result(const Task& task) {
  Refined flat;
  flat.points = task.outline.points.positions;
  flat.triangulation.distinct = task.mesh.vertices;
  return flat;
}

// Everything after.
Refined finish(Task& task, const internal::TriangleBounds& bounds) {
  internal::make_delaunay(task.mesh);
  task.counts.excepted = count_excepted(task.mesh, bounds);
  Refined refined = result_of(task);
  for (SmallCorner& corner : task.corners) corner.row = row_of(task, corner.row);
  refined.small_corners = std::move(task.corners);
  refined.counts = task.counts;
  if (task.given) add_heights(task, refined);
  return refined;
}

}  // namespace

Refined refine(const Outline& outline, const RefineOptions& options) {
  check(outline, options);
  const internal::RefinementWay way = internal::refinement_way(options.method);
  Task task{outline, options, {}, {}, {}, {}, {}};
  if (!prepare(task)) return flat_result(task);
  const internal::TriangleBounds bounds(options.min_angle, options.max_area, way.measure);
  way.run(task.mesh, bounds, limits_of(options), task.counts);
  return finish(task, bounds);
}

Refined refine(comm::Communicator& communicator, const Outline& outline,
               const RefineOptions& options) {
  const internal::RefinementWay way = internal::refinement_way(options.method, true);
  Task task{outline, options, {}, {}, {}, {}, {}};
  struct Prepared {
    std::uint64_t has_triangles, has_too_many, most_vertices;
  } prepared{};
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (communicator.rank() != 0) return;
    check(outline, options);
    prepared.most_vertices = most_vertices(options);
    try {
      prepared.has_triangles = prepare(task) ? 1 : 0;
    } catch (const std::length_error&) {
      prepared.has_too_many = 1;
    }
  });
  prepared =
      comm::broadcast(communicator, 0, comm::Buffer::of_value(prepared)).as<Prepared>().front();
  internal::RefinementLimits limits = limits_of(options);
  limits.most_vertices = prepared.most_vertices;
  if (prepared.has_too_many != 0) {
    throw comm::Agreed<std::length_error>(internal::too_many_points(limits.most_vertices));
  }
  const bool is_first = communicator.rank() == 0;
  if (prepared.has_triangles == 0) return is_first ? flat_result(task) : Refined{};
  const internal::TriangleBounds bounds(options.min_angle, options.max_area, way.measure);
  std::vector<RefineRank> ranks =
      way.run_over_ranks(communicator, task.mesh, bounds, limits, task.counts);
  Refined refined;
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (!is_first) return;
    refined = finish(task, bounds);
    refined.ranks = std::move(ranks);
  });
  return refined;
}

Triangulation domain_of(const Refined& refined) {
  Triangulation domain;
  domain.distinct = refined.triangulation.distinct;
  const std::vector<std::uint32_t>& vertices = refined.triangulation.vertices;
  domain.vertices.reserve(vertices.size());
  for (std::size_t t = 0; t < refined.inside.size(); ++t) {
    if (refined.inside[t] == 0) continue;
    domain.vertices.insert(domain.vertices.end(),
                           vertices.begin() + static_cast<std::ptrdiff_t>(3 * t),
                           vertices.begin() + static_cast<std::ptrdiff_t>(3 * t + 3));
  }
  return domain;
}

}  // namespace delray::delaunay
