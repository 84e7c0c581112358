#include "delaunay/internal/cavity_insertion.h"

#include <algorithm>
#include <array>
#include <new>
#include <optional>
#include <vector>

#include "delaunay/internal/cavity.h"
#include "delaunay/internal/curve_order3.h"
#include "delaunay/internal/sphere_tests.h"
#include "delaunay/internal/stopwatch.h"
#include "delaunay/mesh.h"
#include "delaunay/predicates.h"

namespace delray::delaunay::internal {
namespace {

bool collinear(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const auto flat = [&](int i, int j) {
    return orient2d({a[i], a[j]}, {b[i], b[j]}, {c[i], c[j]}) == 0;
  };
  return flat(0, 1) && flat(1, 2) && flat(2, 0);
}

// The first four points in order that are not coplanar, positively oriented.
std::optional<std::array<VertexNumber, 4>> first_tetrahedron(const SpaceVertex* vertices,
                                                             std::size_t n) {
  const auto at = [&](VertexNumber v) -> const glm::dvec3& { return vertices[v + 1].position; };
  VertexNumber b = 1;
  while (b < n && at(b) == at(0)) ++b;
  VertexNumber c = b + 1;
  while (c < n && collinear(at(0), at(b), at(c))) ++c;
  for (VertexNumber d = c + 1; d < n; ++d) {
    const int sign = orient3d(at(0), at(b), at(c), at(d));
    if (sign > 0) return std::array{VertexNumber{0}, b, c, d};
    if (sign < 0) return std::array{VertexNumber{0}, c, b, d};
  }
  return std::nullopt;
}

// A tetrahedron and the ghosts around it, in slots 0 to 4.
void start_mesh(Mesh<3>& mesh, const std::array<VertexNumber, 4>& tetrahedron) {
  // The other corners of facet k, seen from outside.
  constexpr std::array<std::array<unsigned, 3>, 4> kFacets = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  // Where corner k is in the ghost of facet f; the infinite vertex replaces f itself.
  const auto place = [&](unsigned f, unsigned k) {
    for (unsigned i = 0; i < 3; ++i) {
      if (kFacets[f][i] == k) return i;
    }
    return 3U;
  };
  for (unsigned k = 0; k < 4; ++k) mesh.set_vertex(corner_of(0, k), tetrahedron[k]);
  for (unsigned f = 0; f < 4; ++f) {
    for (unsigned i = 0; i < 3; ++i) {
      mesh.set_vertex(corner_of(1 + f, i), tetrahedron[kFacets[f][i]]);
    }
    mesh.set_vertex(corner_of(1 + f, 3), kInfiniteVertex);
    mesh.link(corner_of(1 + f, 3), corner_of(0, f));
    for (unsigned g = 0; g < f; ++g) {
      mesh.link(corner_of(1 + f, place(f, g)), corner_of(1 + g, place(g, f)));
    }
  }
}

std::uint64_t count_distinct(Array<SpaceVertex> vertices) {
  SpaceVertex* const first = vertices.data() + 1;
  SpaceVertex* const last = vertices.data() + vertices.size();
  std::sort(first, last, [](const SpaceVertex& a, const SpaceVertex& b) {
    return lexicographically_less_3d(a.position, b.position);
  });
  return static_cast<std::uint64_t>(std::unique(first, last,
                                                [](const SpaceVertex& a, const SpaceVertex& b) {
                                                  return a.position == b.position;
                                                }) -
                                    first);
}

// Seven tetrahedra to a point and some, as evenly spread points have; more where that is not
// enough.
std::size_t first_slots(std::size_t n) { return 7 * n + n / 8 + 64; }

void grow(Mesh<3>& mesh) {
  const std::size_t size = std::min(mesh.size() + mesh.size() / 2, kMaximumSimplices);
  if (size == mesh.size()) throw std::bad_alloc();
  mesh.grow(size);
}

Triangulation extract_tetrahedra(Mesh<3>&& mesh, Array<SpaceVertex>&& vertices) {
  Triangulation result;
  result.dim = 3;
  std::size_t live = 0;
  for (SimplexNumber t = 0; t < mesh.size(); ++t) live += mesh.is_dead(t) ? 0 : 1;
  Array<VertexNumber> corners = std::move(mesh).take_finite();
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = vertices[corners[i] + 1].row;
  vertices = {};
  result.vertices.assign(corners.data(), corners.data() + corners.size());
  result.hull_facets = live - result.size();
  return result;
}

}  // namespace

Triangulation insert_by_cavities(PointView<double> points, const Options& options) {
  Statistics unused;
  Statistics& seconds = options.statistics != nullptr ? *options.statistics : unused;
  const bool timed = options.statistics != nullptr;
  Stopwatch watch;

  const PointRange range = finite_range(points);
  CurveOrder3 order = curve_order3(points, range, options.seed);
  const std::size_t n = points.size();
  SpaceVertex* const vertices = order.vertices.data();
  seconds.order = watch.lap();

  const auto start = first_tetrahedron(vertices, n);
  if (!start) {
    Triangulation result;
    result.dim = 3;
    result.distinct = n == 0 ? 0 : count_distinct(std::move(order.vertices));
    return result;
  }
  const SphereTests tests(range);
  Mesh<3> mesh(first_slots(n));
  start_mesh(mesh, *start);
  Cavity<Everywhere> cavity(mesh, vertices, tests, {});
  cavity.add_slots(5, static_cast<SimplexNumber>(mesh.size()));
  cavity.start_at(0);
  std::uint64_t distinct = 4;
  for (VertexNumber vertex = 0; vertex < n; ++vertex) {
    if (options.progress != nullptr) options.progress->advance();
    if (std::ranges::find(*start, vertex) != start->end()) continue;
    if (timed) watch.lap();
    SimplexNumber place = 0;
    const Insertion found = cavity.locate(vertex, place);
    if (timed) seconds.locate += watch.lap();
    if (found == Insertion::kEqual) continue;
    while (cavity.insert(vertex, place) == Insertion::kFull) {
      grow(mesh);
      cavity.add_slots(cavity.unused(), static_cast<SimplexNumber>(mesh.size()));
    }
    if (timed) seconds.subdivide += watch.lap();
    ++distinct;
  }
  watch.lap();
  mesh.shrink(cavity.unused());
  Triangulation result = extract_tetrahedra(std::move(mesh), std::move(order.vertices));
  result.distinct = distinct;
  seconds.extract = watch.lap();
  return result;
}

}  // namespace delray::delaunay::internal
