#include "scenes/internal/order.h"

#include <algorithm>
#include <cmath>

#include "parallel/parallel_for.h"

namespace delray::scenes::internal {
namespace {

// A mesh below this is taken as a whole.
constexpr std::size_t kLeastTriangles = 1024;
// Triangles in the runs that are compared.
constexpr std::size_t kRun = 128;
// The order is changed where runs become so much smaller.
constexpr double kWorthwhile = 0.8;
// It is not asked for where the sides of a run's box add up to no more than so many times the side
// of a square of its area: those of a flat square add up to 2 or 3.
constexpr double kCompact = 4;
constexpr std::size_t kGrain = 1 << 14;  // triangles: some hundred microseconds
constexpr int kAxisBits = 21;

struct Place {
  std::uint64_t code;
  std::uint32_t triangle;
  bool operator<(const Place& other) const {
    return code != other.code ? code < other.code : triangle < other.triangle;
  }
};

// Moves bit k to bit 3 k, for 21 bits.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1F00000000FFFFU;
  x = (x | x << 16) & 0x1F0000FF0000FFU;
  x = (x | x << 8) & 0x100F00F00F00F00FU;
  x = (x | x << 4) & 0x10C30C30C30C30C3U;
  return (x | x << 2) & 0x1249249249249249U;
}

std::vector<Place> places_on_curve(const Mesh& mesh) {
  geometry::Box3 box;
  for (const glm::vec3& p : mesh.positions) box.include(p);
  const glm::vec3 size = box.size();
  const float largest = std::max({size.x, size.y, size.z});
  // Positions that are not finite have a place of their own: the first.
  const float scale = largest > 0 ? static_cast<float>((1 << kAxisBits) - 1) / largest : 0.0F;
  std::vector<Place> places(mesh.triangles.size());
  parallel::parallel_for(0, places.size(), kGrain, [&](std::size_t t) {
    const glm::uvec3& v = mesh.triangles[t];
    const glm::vec3 sum = (mesh.positions[v.x] - box.low) + (mesh.positions[v.y] - box.low) +
                          (mesh.positions[v.z] - box.low);
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) {
      const float place = sum[k] * (scale / 3.0F);
      const bool inside = place >= 0 && place < static_cast<float>(1 << kAxisBits);
      code |= spread(inside ? static_cast<std::uint64_t>(place) : 0) << k;
    }
    places[t] = {code, static_cast<std::uint32_t>(t)};
  });
  std::sort(places.begin(), places.end());
  return places;
}

// Sums over all runs: the sides of its box, and the side of a square with its area.
struct RunSizes {
  double box = 0, square = 0;
};

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

void number_vertices_as_used(Mesh& mesh) {
  std::vector<std::uint32_t> number(mesh.positions.size(), kNone), old_number;
  old_number.reserve(number.size());
  for (glm::uvec3& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& vertex = triangle[k];
      if (number[vertex] == kNone) {
        number[vertex] = static_cast<std::uint32_t>(old_number.size());
        old_number.push_back(vertex);
      }
      vertex = number[vertex];
    }
  for (std::uint32_t i = 0; i < number.size(); ++i)
    if (number[i] == kNone) old_number.push_back(i);
  reorder(old_number, mesh.positions);
  reorder(old_number, mesh.normals);
  reorder(old_number, mesh.uvs);
  reorder(old_number, mesh.tangents);
  reorder(old_number, mesh.colours);
}

}  // namespace

void order_for_locality(Mesh& mesh) {
  if (mesh.triangles.size() < kLeastTriangles) return;
  const RunSizes before =
      sizes_of_runs(mesh, [&](std::size_t t) -> const glm::uvec3& { return mesh.triangles[t]; });
  if (before.box < kCompact * before.square) return;
  const std::vector<Place> places = places_on_curve(mesh);
  const RunSizes after = sizes_of_runs(
      mesh, [&](std::size_t t) -> const glm::uvec3& { return mesh.triangles[places[t].triangle]; });
  // Not worthwhile either where something is not a number.
  if (!(after.box < kWorthwhile * before.box)) return;
  std::vector<glm::uvec3> triangles(places.size());
  for (std::size_t t = 0; t < places.size(); ++t) triangles[t] = mesh.triangles[places[t].triangle];
  mesh.triangles = std::move(triangles);
  number_vertices_as_used(mesh);
}

}  // namespace delray::scenes::internal
