// Drops triangles with two corners in one place and meshes that this leaves empty, renumbers the
// instances, and refuses a scene that is empty or whose placed coordinates are too large.
#include "scenes/files/finish.h"

#include <algorithm>
#include <functional>

#include "parallel/parallel_for.h"
#include "scenes/geometry/origin.h"

namespace delray::scenes::internal {
namespace {

constexpr std::size_t kTrianglesPerBlock = 1 << 14;  // tens of microseconds

std::uint64_t drop_degenerate(Mesh& mesh) {
  const auto degenerate = [&](const glm::uvec3& t) { return is_degenerate(mesh, t); };
  const auto count = parallel::parallel_reduce(
      0, mesh.triangles.size(), kTrianglesPerBlock, std::uint64_t{0},
      [&](std::size_t first, std::size_t last) {
        const glm::uvec3* const triangles = mesh.triangles.data();
        return static_cast<std::uint64_t>(
            std::count_if(triangles + first, triangles + last, degenerate));
      },
      std::plus<>());
  if (count > 0) std::erase_if(mesh.triangles, degenerate);
  return count;
}

void drop_empty_meshes(Scene& scene) {
  std::vector<std::uint32_t> number(scene.meshes.size(), kNone);
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < scene.meshes.size(); ++i) {
    if (scene.meshes[i].triangles.empty()) continue;
    number[i] = kept;
    if (kept != i) scene.meshes[kept] = std::move(scene.meshes[i]);
    ++kept;
  }
  scene.meshes.resize(kept);
  Animations& animations = scene.animations;
  for (DeformedMesh& deformed : animations.meshes) deformed.mesh = number[deformed.mesh];
  std::vector<std::uint32_t> instance_number(scene.instances.size(), kNone);
  std::uint32_t instances = 0;
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    if (number[scene.instances[i].mesh] != kNone) instance_number[i] = instances++;
  for (Follower& follower : animations.instances)
    follower.number = instance_number[follower.number];
  std::erase_if(animations.instances, [](const Follower& f) { return f.number == kNone; });
  std::erase_if(scene.instances, [&](const Instance& i) { return number[i.mesh] == kNone; });
  for (Instance& instance : scene.instances) instance.mesh = number[instance.mesh];
}

// Meshes that bend, whose triangles may have no area in one pose and some in another.
std::vector<std::uint8_t> bending_meshes(const Scene& scene) {
  std::vector<std::uint8_t> bends(scene.meshes.size(), 0);
  for (const DeformedMesh& deformed : scene.animations.meshes) bends[deformed.mesh] = 1;
  return bends;
}

}  // namespace

bool is_degenerate(const Mesh& mesh, const glm::uvec3& triangle) {
  const auto same = [&mesh](std::uint32_t a, std::uint32_t b) {
    return a == b || mesh.positions[a] == mesh.positions[b];
  };
  return same(triangle.x, triangle.y) || same(triangle.y, triangle.z) ||
         same(triangle.z, triangle.x);
}

void finish(const Source& source, Scene& scene) {
  std::uint64_t degenerate = 0;
  const std::vector<std::uint8_t> bends = bending_meshes(scene);
  for (std::size_t i = 0; i < bends.size(); ++i) {
    Mesh& mesh = scene.meshes[i];
    if (mesh.has_triangles() && bends[i] == 0) degenerate += drop_degenerate(mesh);
  }
  drop_empty_meshes(scene);
  if (scene.instances.empty()) {
    source.fail("", degenerate == 0   ? kNoTriangles
                    : degenerate == 1 ? "its 1 triangle has two corners in one place"
                                      : "its " + std::to_string(degenerate) +
                                            " triangles have two corners in one place");
  }
  if (degenerate > 0) {
    source.warn(std::to_string(degenerate) + " triangles with two corners in one place left out");
  }
  if (scene.materials.empty()) scene.materials.emplace_back();

  const geometry::Box3 box = bounds(scene);
  const glm::dvec3 low = glm::dvec3(box.low) + scene.origin;
  const glm::dvec3 high = glm::dvec3(box.high) + scene.origin;
  const double distance = reach_of({low, high});
  if (!(distance <= double{static_cast<float>(kLargestCoordinate)})) {
    source.fail("", "a placed coordinate is not finite or larger than 1e18");
  }
}

}  // namespace delray::scenes::internal
