// Numbers points as they lie in space, and measures how densely, in runs of neighbours.
#include "scenes/points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "parallel/parallel_for.h"
#include "scenes/geometry/order.h"

namespace delray::scenes {
namespace {

constexpr std::size_t kGrain = 1 << 14;  // points: some microseconds
constexpr std::size_t kRun = 128;        // points that are compared with each other
constexpr std::size_t kMostRuns = 512;
constexpr std::size_t kNeighbour = 8;

// The squared distance from point i to its eighth neighbour in a run, or to the last of a few.
float squared_distance(std::span<const glm::vec3> run, std::size_t i) {
  std::array<float, kRun> squared{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < run.size(); ++k) {
    const glm::vec3 apart = run[k] - run[i];
    if (k != i) squared[count++] = glm::dot(apart, apart);
  }
  const std::size_t at = std::min(kNeighbour, count) - 1;
  std::nth_element(squared.begin(), squared.begin() + static_cast<std::ptrdiff_t>(at),
                   squared.begin() + static_cast<std::ptrdiff_t>(count));
  return squared[at];
}

}  // namespace

void make_points(Mesh& mesh, const Shape& shape) {
  mesh.shape = shape;
  mesh.triangles.resize(mesh.positions.size());
  parallel::parallel_for(0, mesh.triangles.size(), kGrain, [&](std::size_t i) {
    mesh.triangles[i] = glm::uvec3(static_cast<std::uint32_t>(i));
  });
  internal::order_for_locality(mesh);
}

float point_spacing(const Mesh& mesh) {
  const std::size_t n = mesh.positions.size();
  if (n < 2) return 0;
  const std::size_t runs = (n + kRun - 1) / kRun, step = (runs + kMostRuns - 1) / kMostRuns;
  std::vector<float> distances(runs / step + 1, -1.0F);
  parallel::parallel_for(0, distances.size(), 1, [&](std::size_t k) {
    const std::size_t first = k * step * kRun;
    if (first + 2 > n) return;
    const auto run = std::span(mesh.positions).subspan(first, std::min(kRun, n - first));
    std::vector<float> own(run.size());
    for (std::size_t i = 0; i < run.size(); ++i) own[i] = squared_distance(run, i);
    const auto middle = own.begin() + static_cast<std::ptrdiff_t>(own.size() / 2);
    std::nth_element(own.begin(), middle, own.end());
    distances[k] = *middle;
  });
  std::erase_if(distances, [](float d) { return d < 0; });
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  const auto neighbours = static_cast<float>(std::min(kNeighbour, n - 1));
  return std::sqrt(*middle * std::numbers::pi_v<float> / neighbours);
}

void set_radii_in_units(Scene& scene, const Camera& camera, int height) {
  const View view = make_view(camera, height, height);
  const float distance = camera.orthographic() ? 1.0F : glm::distance(camera.eye, camera.at);
  for (const Instance& instance : scene.instances) {
    Mesh& mesh = scene.meshes[instance.mesh];
    if (mesh.has_triangles() || !mesh.shape.in_pixels) continue;
    const glm::mat4x3& m = instance.transform;
    const float longest =
        std::sqrt(std::max({glm::dot(m[0], m[0]), glm::dot(m[1], m[1]), glm::dot(m[2], m[2])}));
    mesh.shape.in_pixels = false;
    if (longest > 0) mesh.shape.radius *= distance / (view.scale * longest);
  }
}

}  // namespace delray::scenes
