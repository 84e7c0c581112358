// Orders triangles by a k-d tree over their centres (Bentley 1975).
//
// Runs of triangles are measured first: if their boxes are compact already, or would hardly become
// smaller, the order stays. Otherwise triangles are halved at multiples of a cluster and later of a
// vector along the longest side of their box, level by level until every thread has a part, then
// part by part. Vertices are numbered by first use. O(triangles log triangles).
//
// Degenerate: centres that are not finite count as 0, and equal ones keep the order of the mesh.
#include "scenes/geometry/order.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "parallel/parallel_for.h"
#include "scenes/geometry/number_by_use.h"

namespace delray::scenes::internal {
namespace {

// A mesh below this is taken as a whole.
constexpr std::size_t kLeastTriangles = 1024;
constexpr std::size_t kRun = kTrianglesOfRun;
// The order is changed where runs become so much smaller.
constexpr double kWorthwhile = 0.8;
// It is not asked for where the sides of a run's box add up to no more than so many times the side
// of a square of its area: those of a flat square add up to 2 or 3.
constexpr double kCompact = 4;
constexpr std::size_t kGrain = 1 << 14;  // triangles: some hundred microseconds
// Renderers take so many triangles for a cluster, and so many for a vector.
constexpr std::size_t kCluster = 128, kVector = 16;
// Parts that threads share are no smaller, and no more.
constexpr std::size_t kLeastPart = 4 * kCluster, kMostParts = 256;

// A triangle, and three times its centre.
struct Place {
  glm::vec3 at;
  std::uint32_t triangle;
};

std::vector<Place> places_of(const Mesh& mesh) {
  std::vector<Place> places(mesh.triangles.size());
  parallel::parallel_for(0, places.size(), kGrain, [&](std::size_t t) {
    const glm::uvec3& v = mesh.triangles[t];
    glm::vec3 sum = mesh.positions[v.x] + mesh.positions[v.y] + mesh.positions[v.z];
    // Coordinates that are not finite have to be somewhere.
    for (int k = 0; k < 3; ++k) sum[k] = std::isfinite(sum[k]) ? sum[k] : 0.0F;
    places[t] = {sum, static_cast<std::uint32_t>(t)};
  });
  return places;
}

// Primitives before `middle` are not behind the others along the longest side of their box.
void halve(std::span<Place> places, std::size_t middle) {
  geometry::Box3 box;
  for (const Place& place : places) box.include(place.at);
  const glm::vec3 size = box.size();
  int axis = size.y > size.x ? 1 : 0;
  if (size.z > size[axis]) axis = 2;
  std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(middle),
                   places.end(), [axis](const Place& a, const Place& b) {
                     return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis]
                                                     : a.triangle < b.triangle;
                   });
}

// Halves at a multiple of `unit`. REQUIRES: size > unit.
std::size_t middle_of(std::size_t size, std::size_t unit) {
  return std::max<std::size_t>(size / unit / 2, 1) * unit;
}

void order_all(std::span<Place> places) {
  if (places.size() <= kVector) {
    std::sort(places.begin(), places.end(),
              [](const Place& a, const Place& b) { return a.triangle < b.triangle; });
    return;
  }
  const std::size_t middle =
      middle_of(places.size(), places.size() > kCluster ? kCluster : kVector);
  halve(places, middle);
  order_all(places.first(middle));
  order_all(places.subspan(middle));
}

// Level by level until there are parts for all threads, then part by part.
void order_in_parallel(std::span<Place> places) {
  std::vector<std::span<Place>> parts = {places};
  while (parts.size() < kMostParts && places.size() / parts.size() > kLeastPart) {
    std::vector<std::span<Place>> halves(2 * parts.size());
    parallel::parallel_for(0, parts.size(), 1, [&](std::size_t i) {
      const std::size_t middle = middle_of(parts[i].size(), kCluster);
      halve(parts[i], middle);
      halves[2 * i] = parts[i].first(middle);
      halves[2 * i + 1] = parts[i].subspan(middle);
    });
    parts = std::move(halves);
  }
  parallel::parallel_for(0, parts.size(), 1, [&](std::size_t i) { order_all(parts[i]); });
}

// triangle(t) is the t-th in order.
template <class Triangle>
RunSizes sizes_of_runs(const Mesh& mesh, Triangle&& triangle) {
  const std::size_t runs = (mesh.triangles.size() + kRun - 1) / kRun;
  return parallel::parallel_reduce(
      0, runs, kGrain / kRun, RunSizes{},
      [&](std::size_t first, std::size_t last) {
        RunSizes sum;
        for (std::size_t run = first; run < last; ++run) {
          geometry::Box3 box;
          double area = 0;
          for (std::size_t t = run * kRun; t < std::min((run + 1) * kRun, mesh.triangles.size());
               ++t) {
            const glm::uvec3& v = triangle(t);
            const glm::vec3 &a = mesh.positions[v.x], &b = mesh.positions[v.y],
                            &c = mesh.positions[v.z];
            box.include(a);
            box.include(b);
            box.include(c);
            area += glm::length(glm::cross(b - a, c - a)) * 0.5F;
          }
          const glm::vec3 size = box.size();
          sum.box += double{size.x} + size.y + size.z;
          sum.square += std::sqrt(area);
        }
        return sum;
      },
      [](const RunSizes& a, const RunSizes& b) {
        return RunSizes{a.box + b.box, a.square + b.square};
      });
}

template <class Value>
void reorder(const std::vector<std::uint32_t>& old_number, std::vector<Value>& values) {
  if (values.empty()) return;
  std::vector<Value> result(values.size());
  parallel::parallel_for(0, values.size(), kGrain,
                         [&](std::size_t i) { result[i] = values[old_number[i]]; });
  values = std::move(result);
}

// Those that no triangle has come last.
void number_vertices_as_used(Mesh& mesh) {
  std::vector<std::uint32_t> number(mesh.positions.size(), kNone), old_number(number.size());
  auto next = static_cast<std::uint32_t>(number_by_first_corner(mesh.triangles, number));
  if (next < number.size())
    for (std::uint32_t& n : number) n = n == kNone ? next++ : n;
  parallel::parallel_for(0, number.size(), kGrain, [&](std::size_t v) {
    old_number[number[v]] = static_cast<std::uint32_t>(v);
  });
  renumber_vertices(old_number, mesh);
}

}  // namespace

void renumber_vertices(const std::vector<std::uint32_t>& old_number, Mesh& mesh) {
  reorder(old_number, mesh.positions);
  reorder(old_number, mesh.normals);
  reorder(old_number, mesh.uvs);
  reorder(old_number, mesh.uvs2);
  reorder(old_number, mesh.tangents);
  reorder(old_number, mesh.colours);
}

RunSizes sizes_of_runs(const Mesh& mesh) {
  return sizes_of_runs(mesh, [&](std::size_t t) -> const glm::uvec3& { return mesh.triangles[t]; });
}

bool are_compact(const RunSizes& sizes) { return sizes.box < kCompact * sizes.square; }

void order_for_locality(Mesh& mesh) {
  if (mesh.triangles.size() < kLeastTriangles) return;
  const RunSizes before = sizes_of_runs(mesh);
  if (are_compact(before)) return;
  std::vector<Place> places = places_of(mesh);
  order_in_parallel(places);
  const RunSizes after = sizes_of_runs(
      mesh, [&](std::size_t t) -> const glm::uvec3& { return mesh.triangles[places[t].triangle]; });
  // Not worthwhile either where something is not a number.
  if (!(after.box < kWorthwhile * before.box)) return;
  std::vector<glm::uvec3> triangles(places.size());
  parallel::parallel_for(0, places.size(), kGrain,
                         [&](std::size_t t) { triangles[t] = mesh.triangles[places[t].triangle]; });
  mesh.triangles = std::move(triangles);
  if (mesh.triangles.size() <= kMostNumberedTriangles) number_vertices_as_used(mesh);
}

}  // namespace delray::scenes::internal
