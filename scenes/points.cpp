// Numbers points as they lie along a curve, and measures how densely they lie, in runs of
// neighbours.
#include "scenes/points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "parallel/parallel_for.h"
#include "scenes/geometry/order.h"
#include "scenes/point_order.h"

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

void make_points(Mesh& mesh, const Shape& shape, const geometry::Box3& most) {
  mesh.shape = shape;
  geometry::Box3 box = most;
  if (most.empty())
    for (const glm::vec3& p : mesh.positions) box.include(p);
  const std::vector<PointPlace> order = order_points(mesh.positions, PointOrder(box));
  std::vector<std::uint32_t> old_number(order.size());
  mesh.triangles.resize(order.size());
  parallel::parallel_for(0, order.size(), kGrain, [&](std::size_t i) {
    old_number[i] = order[i].point;
    mesh.triangles[i] = glm::uvec3(static_cast<std::uint32_t>(i));
  });
  internal::renumber_vertices(old_number, mesh);
}

std::size_t PointSpacing::step() const {
  const std::size_t runs = (n_ + kRun - 1) / kRun;
  return std::max<std::size_t>(1, (runs + kMostRuns - 1) / kMostRuns) * kRun;
}

void PointSpacing::add(std::span<const glm::vec3> points) {
  for (const glm::vec3& p : points) {
    if (next_++ % step() >= kRun) continue;
    run_.push_back(p);
    if (run_.size() == kRun) end_run();
  }
}

void PointSpacing::end_run() {
  if (run_.size() > 1) {
    std::vector<float> own(run_.size());
    for (std::size_t i = 0; i < run_.size(); ++i) own[i] = squared_distance(run_, i);
    const auto middle = own.begin() + static_cast<std::ptrdiff_t>(own.size() / 2);
    std::nth_element(own.begin(), middle, own.end());
    distances_.push_back(*middle);
  }
  run_.clear();
}

float PointSpacing::spacing() {
  end_run();
  if (distances_.empty()) return 0;
  const auto middle = distances_.begin() + static_cast<std::ptrdiff_t>(distances_.size() / 2);
  std::nth_element(distances_.begin(), middle, distances_.end());
  const auto neighbours = static_cast<float>(std::min(kNeighbour, n_ - 1));
  return std::sqrt(*middle * std::numbers::pi_v<float> / neighbours);
}

float point_spacing(const Mesh& mesh) {
  PointSpacing spacing(mesh.positions.size());
  spacing.add(mesh.positions);
  return spacing.spacing();
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
