// Triangulations behind the functions of delray.h.
#include <cstring>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "c/delray.h"
#include "c/guard.h"
#include "delaunay/interpolate.h"
#include "delaunay/query.h"
#include "delaunay/triangulate.h"
#include "delaunay/verify.h"
#include "delaunay/write_mesh.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

// What the handle points to. Queries are made by whoever asks first.
struct DelrayTriangulation_ {
  delray::delaunay::PointView<double> points;
  std::vector<glm::dvec3> widened;  // of 32-bit points
  delray::delaunay::Triangulation triangulation;
  int threads = 1;

  const delray::delaunay::Query& query() {
    const std::scoped_lock lock(mutex);
    if (!made_query) made_query.emplace(points, triangulation);
    return *made_query;
  }
  const std::vector<std::uint32_t>& hull() {
    const std::scoped_lock lock(mutex);
    if (!made_hull) made_hull = hull_facets(triangulation);
    return *made_hull;
  }

 private:
  std::mutex mutex;
  std::optional<delray::delaunay::Query> made_query;
  std::optional<std::vector<std::uint32_t>> made_hull;
};

namespace delray::c {
namespace {

using delaunay::PointView;

struct Points {
  PointView<double> view;
  std::vector<glm::dvec3> widened;
};

Points points_of(const DelrayPoints* points, int dim) {
  require(points, "points");
  if (dim != 2 && dim != 3)
    throw std::invalid_argument("dim: " + std::to_string(dim) + " is neither 2 nor 3");
  if (points->count > 0) require(points->data, "points->data");
  const bool is_double = points->type == DELRAY_FLOAT64;
  if (!is_double && points->type != DELRAY_FLOAT32)
    throw std::invalid_argument("points->type is neither DELRAY_FLOAT64 nor DELRAY_FLOAT32");
  const std::size_t number = is_double ? sizeof(double) : sizeof(float);
  const std::size_t least = number * static_cast<std::size_t>(dim);
  const std::size_t stride = points->stride == 0 ? least : points->stride;
  if (stride < least || stride % number != 0)
    throw std::invalid_argument("points->stride: " + std::to_string(stride) +
                                " is no distance of points of " + std::to_string(least) + " bytes");
  Points result;
  const auto* const data = static_cast<const std::byte*>(points->data);
  if (is_double) {
    result.view = {data, points->count, stride};
    return result;
  }
  const PointView<float> floats{data, points->count, stride};
  result.widened.resize(points->count);
  parallel::parallel_for(0, points->count, std::size_t{1} << 14, [&](std::size_t i) {
    result.widened[i] = {floats(i, 0), floats(i, 1), dim == 3 ? floats(i, 2) : 0.0F};
  });
  result.view = delaunay::view(result.widened);
  return result;
}

// Names of older programs, whose options are shorter, keep their defaults.
delaunay::Options options_of(const DelrayTriangulateOptions* options) {
  DelrayTriangulateOptions given = DELRAY_TRIANGULATE_OPTIONS;
  if (options != nullptr) {
    if (options->size == 0 || options->size > sizeof(given))
      throw std::invalid_argument("options->size: begin with DELRAY_TRIANGULATE_OPTIONS");
    std::memcpy(&given, options, options->size);
  }
  delaunay::Options how;
  how.dim = given.dim;
  how.threads = given.threads;
  how.seed = given.seed;
  const auto take = [](const char* name, std::string& to) {
    if (name != nullptr) to = name;
  };
  take(given.method, how.method);
  take(given.location, how.location);
  take(given.split, how.split);
  take(given.order, how.order);
  return how;
}

int allowed_threads(int threads) {
  if (threads < 1 || threads > delaunay::kMostThreads)
    throw std::invalid_argument("threads: " + std::to_string(threads) + " is not from 1 to " +
                                std::to_string(delaunay::kMostThreads));
  return threads;
}

template <class F>
auto with_threads(int threads, F&& f) {
  const parallel::AllowThreads allowed(threads);
  parallel::Arena arena(threads);
  return arena.execute(f);
}

// f(place, i) for each place.
template <class F>
void for_each_place(DelrayTriangulation t, const double* places, std::uint64_t count, F&& f) {
  require(t, "triangulation");
  if (count > 0) require(places, "places");
  const auto dim = static_cast<std::size_t>(t->triangulation.dim);
  constexpr std::size_t kGrain = 256;  // places; microseconds each
  with_threads(t->threads, [&] {
    parallel::parallel_for(0, count, kGrain, [&](std::size_t i) {
      const double* const p = places + i * dim;
      f(glm::dvec3(p[0], p[1], dim == 3 ? p[2] : 0.0), i);
    });
  });
}

void triangulate(const DelrayPoints* points, const DelrayTriangulateOptions* options,
                 DelrayTriangulation* to) {
  require(to, "triangulation");
  const delaunay::Options how = options_of(options);
  auto made = std::make_unique<DelrayTriangulation_>();
  made->threads = allowed_threads(how.threads);
  with_threads(made->threads, [&] {
    Points given = points_of(points, how.dim);
    made->widened = std::move(given.widened);
    made->points = made->widened.empty() ? given.view : delaunay::view(made->widened);
    made->triangulation = delaunay::triangulate(made->points, how).triangulation;
  });
  *to = made.release();
}

void verify(const DelrayPoints* points, int dim, const std::uint32_t* simplices,
            std::uint64_t count, DelrayVerdict* to) {
  require(to, "verdict");
  if (count > 0) require(simplices, "simplices");
  const Points given = points_of(points, dim);
  const delaunay::Verdict verdict = delaunay::verify_simplices(
      dim, given.view, {simplices, count * (static_cast<std::size_t>(dim) + 1)});
  to->valid = verdict.valid ? 1 : 0;
  to->delaunay = verdict.delaunay ? 1 : 0;
  to->canonical = verdict.canonical ? 1 : 0;
  to->simplex = verdict.simplex.value_or(std::numeric_limits<std::uint64_t>::max());
  to->distinct = verdict.distinct;
  const std::size_t length = verdict.reason.copy(to->reason, sizeof(to->reason) - 1);
  to->reason[length] = '\0';
}

}  // namespace
}  // namespace delray::c

using delray::c::guarded;
using delray::c::guarded_value;
using delray::c::require;

extern "C" {

DelrayStatus delrayTriangulate(const DelrayPoints* points, const DelrayTriangulateOptions* options,
                               DelrayTriangulation* triangulation) {
  return guarded([&] { delray::c::triangulate(points, options, triangulation); });
}

void delrayReleaseTriangulation(DelrayTriangulation triangulation) { delete triangulation; }

uint64_t delraySimplexCount(DelrayTriangulation triangulation) {
  return guarded_value([&] {
    require(triangulation, "triangulation");
    return std::uint64_t{triangulation->triangulation.size()};
  });
}

const uint32_t* delraySimplices(DelrayTriangulation triangulation) {
  return guarded_value([&]() -> const uint32_t* {
    require(triangulation, "triangulation");
    return triangulation->triangulation.vertices.data();
  });
}

const uint32_t* delrayNeighbours(DelrayTriangulation triangulation) {
  return guarded_value([&]() -> const uint32_t* {
    require(triangulation, "triangulation");
    return triangulation->query().adjacency().neighbours.data();
  });
}

const uint32_t* delrayHullFacets(DelrayTriangulation triangulation, uint64_t* count) {
  return guarded_value([&]() -> const uint32_t* {
    require(triangulation, "triangulation");
    require(count, "count");
    const auto& facets = triangulation->hull();
    *count = facets.size() / static_cast<std::size_t>(triangulation->triangulation.dim);
    return facets.data();
  });
}

DelrayStatus delrayHash(DelrayTriangulation triangulation, char hash[33]) {
  return guarded([&] {
    require(triangulation, "triangulation");
    require(hash, "hash");
    const std::string text = to_string(delray::delaunay::hash(triangulation->triangulation));
    hash[text.copy(hash, 32)] = '\0';
  });
}

DelrayStatus delrayLocate(DelrayTriangulation triangulation, const double* places, uint64_t count,
                          uint32_t* simplices) {
  return guarded([&] {
    require(triangulation, "triangulation");
    if (count > 0) require(simplices, "simplices");
    const delray::delaunay::Query& query = triangulation->query();
    delray::c::for_each_place(
        triangulation, places, count,
        [&](const glm::dvec3& q, std::size_t i) { simplices[i] = query.locate(q); });
  });
}

DelrayStatus delrayNearest(DelrayTriangulation triangulation, const double* places, uint64_t count,
                           uint32_t* rows) {
  return guarded([&] {
    require(triangulation, "triangulation");
    if (count > 0) require(rows, "rows");
    const delray::delaunay::Query& query = triangulation->query();
    delray::c::for_each_place(
        triangulation, places, count,
        [&](const glm::dvec3& q, std::size_t i) { rows[i] = query.nearest(q); });
  });
}

DelrayStatus delrayInterpolate(DelrayTriangulation triangulation, DelrayInterpolation how,
                               const double* values, const double* places, uint64_t count,
                               double* results) {
  return guarded([&] {
    require(triangulation, "triangulation");
    if (how != DELRAY_LINEAR && how != DELRAY_NATURAL_NEIGHBOUR)
      throw std::invalid_argument("how is neither DELRAY_LINEAR nor DELRAY_NATURAL_NEIGHBOUR");
    if (triangulation->points.count > 0) require(values, "values");
    if (count > 0) require(results, "results");
    const delray::delaunay::Query& query = triangulation->query();
    const std::span<const double> all(values, triangulation->points.count);
    delray::c::for_each_place(
        triangulation, places, count, [&](const glm::dvec3& q, std::size_t i) {
          const auto value = how == DELRAY_LINEAR ? interpolate_linear(query, all, q)
                                                  : interpolate_natural_neighbour(query, all, q);
          results[i] = value.value_or(std::numeric_limits<double>::quiet_NaN());
        });
  });
}

DelrayStatus delrayVerify(const DelrayPoints* points, int dim, const uint32_t* simplices,
                          uint64_t count, DelrayVerdict* verdict) {
  return guarded([&] { delray::c::verify(points, dim, simplices, count, verdict); });
}

}  // extern "C"
