// Incremental 3D Delaunay triangulation by cavities (Bowyer 1981, Watson 1981), from points to
// result.
//
// Points are sorted into random rounds of growing size, each along a Hilbert curve (Amenta, Choi
// and Rote 2003). A first tetrahedron starts the mesh, cavity_rounds.h inserts the other points,
// and the live tetrahedra are copied out with rows for vertices. Expected O(n log n) for evenly
// spread points; the mesh grows where points make more simplices than such points do.
//
// Degenerate: if all points lie in one plane there is no first tetrahedron and the result has no
// simplices, but still counts the distinct points.
#include "delaunay/cavity/cavity_insertion.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "delaunay/cavity/cavity_rounds.h"
#include "delaunay/insertion/first_tetrahedron.h"
#include "delaunay/mesh/blocks.h"
#include "delaunay/mesh/extract.h"
#include "delaunay/mesh/mesh.h"
#include "delaunay/mesh/slot_pool.h"
#include "delaunay/mesh/start_mesh.h"
#include "delaunay/mesh/stopwatch.h"
#include "delaunay/mesh/with_threads.h"
#include "delaunay/order/curve_order_3d.h"
#include "delaunay/predicates/sphere_tests.h"

namespace delray::delaunay::internal {
namespace {

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

struct Made {
  BuiltMesh<3> built;
  std::vector<std::uint16_t> created_by;
  Statistics seconds;
};

Made make(PointView<double> points, const Options& options) {
  Made result;
  Stopwatch watch;

  const PointRange range = finite_range(points, options.threads);
  CurveOrder3d order = curve_order_3d(points, range, options.seed, options.threads);
  const std::size_t n = points.size();
  result.seconds.order = watch.lap();

  const auto at = [&](VertexNumber v) -> const glm::dvec3& {
    return order.vertices[std::size_t{v} + 1].position;
  };
  const auto start = first_tetrahedron(n, at);
  if (!start) {
    std::vector<glm::dvec3> all(n);
    for (VertexNumber v = 0; v < n; ++v) all[v] = at(v);
    result.built.distinct = count_distinct(std::move(all));
    return result;
  }
  const SphereTests tests(range);
  Mesh<3>& mesh = result.built.mesh;
  mesh = Mesh<3>(first_slots(n, options.threads));
  start_mesh(mesh, *start);
  if (options.progress != nullptr) options.progress->advance(start->size());
  const CavityInput input{mesh, 5, *start, order, range, tests};
  const auto insert = options.threads > 1 ? insert_in_parallel : insert_alone;
  Inserted inserted = insert(input, options);
  result.seconds.locate = inserted.locate_seconds;
  result.seconds.subdivide = inserted.subdivide_seconds;
  result.built.rows = take_rows(std::move(order.vertices), options.threads);
  result.built.distinct = inserted.distinct;
  result.created_by = std::move(inserted.created_by);
  return result;
}

Result run(PointView<double> points, const Options& options) {
  Made made = make(points, options);
  Stopwatch watch;
  const Array<std::uint32_t>& rows = made.built.rows;
  Result result = extract(std::move(made.built.mesh), std::span(rows.data(), rows.size()),
                          options.threads, std::move(made.created_by));
  result.triangulation.distinct = made.built.distinct;
  made.seconds.extract = watch.lap();
  result.statistics = made.seconds;
  return result;
}

}  // namespace

Result insert_by_cavities(PointView<double> points, const Options& options) {
  return with_threads(options.threads, [&] { return run(points, options); });
}

BuiltMesh<3> mesh_by_cavities(PointView<double> points, const Options& options) {
  return with_threads(options.threads, [&] { return make(points, options).built; });
}

}  // namespace delray::delaunay::internal
