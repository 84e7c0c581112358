#include "delaunay/internal/cavity_insertion.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/conflict.h"
#include "delaunay/internal/blocks.h"
#include "delaunay/internal/cavity_rounds.h"
#include "delaunay/internal/curve_order3.h"
#include "delaunay/internal/extract.h"
#include "delaunay/internal/slot_pool.h"
#include "delaunay/internal/sphere_tests.h"
#include "delaunay/internal/stopwatch.h"
#include "delaunay/mesh.h"
#include "delaunay/predicates.h"
#include "parallel/arena.h"

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

// Seven tetrahedra to a point and some, as evenly spread points have, and what threads take and do
// not use; more where that is not enough.
std::size_t first_slots(std::size_t n, int threads) {
  const std::size_t several = threads > 1 ? static_cast<std::size_t>(threads) : 0;
  return 7 * n + n / 8 + 64 + several * SlotPool::kChunk;
}

// The rows of the vertices, close together for those who look up many.
Array<std::uint32_t> take_rows(Array<SpaceVertex>&& vertices, int threads) {
  const Array<SpaceVertex> own = std::move(vertices);
  Array<std::uint32_t> rows(own.size() - 1);
  Blocks(rows.size(), threads).for_each([&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) rows[i] = own[i + 1].row;
  });
  return rows;
}

Triangulation run(PointView<double> points, const Options& options) {
  Statistics unused;
  Statistics& seconds = options.statistics != nullptr ? *options.statistics : unused;
  Stopwatch watch;

  const PointRange range = finite_range(points, options.threads);
  CurveOrder3 order = curve_order3(points, range, options.seed, options.threads);
  const std::size_t n = points.size();
  seconds.order = watch.lap();

  const auto start = first_tetrahedron(order.vertices.data(), n);
  if (!start) {
    Triangulation result;
    result.dim = 3;
    result.distinct = n == 0 ? 0 : count_distinct(std::move(order.vertices));
    return result;
  }
  const SphereTests tests(range);
  Mesh<3> mesh(first_slots(n, options.threads));
  start_mesh(mesh, *start);
  if (options.progress != nullptr) options.progress->advance(start->size());
  const CavityInput input{mesh, 5, *start, order, range, tests};
  const auto insert = options.threads > 1 ? insert_together : insert_alone;
  const std::uint64_t distinct = insert(input, options, options.statistics);
  watch.lap();
  const Array<std::uint32_t> rows = take_rows(std::move(order.vertices), options.threads);
  Triangulation result =
      extract(std::move(mesh), std::span(rows.data(), rows.size()), options.threads);
  result.distinct = distinct;
  seconds.extract = watch.lap();
  return result;
}

}  // namespace

Triangulation insert_by_cavities(PointView<double> points, const Options& options) {
  // An arena takes longer to set up than a thousand points to triangulate.
  if (options.threads <= 1) return run(points, options);
  return parallel::Arena(options.threads).execute([&] { return run(points, options); });
}

}  // namespace delray::delaunay::internal
