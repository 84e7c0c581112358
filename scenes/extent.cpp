// Support points of a scene: the point farthest along a direction. A maximum of numbers that each
// follow from one vertex alone, with ties broken by the vertex, so that no order of triangles,
// threads or ranks has a part in it.
#include "scenes/extent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <tuple>

#include "parallel/parallel_for.h"

namespace delray::scenes {
namespace {

constexpr std::size_t kVertices = 4096;  // some 10 microseconds of transforms and products
constexpr std::size_t kInstances = 256;  // likewise, of boxes

bool farther(const glm::dvec3& direction, const glm::dvec3& a, const glm::dvec3& b) {
  const double reach_a = glm::dot(a, direction), reach_b = glm::dot(b, direction);
  return std::tuple(reach_a, a.x, a.y, a.z) > std::tuple(reach_b, b.x, b.y, b.z);
}

bool contains(const geometry::Box3& box, const glm::vec3& p) {
  return glm::all(glm::lessThanEqual(box.low, p)) && glm::all(glm::lessThanEqual(p, box.high));
}

// No point of the instance is farther along the direction, not even for rounded transforms.
double upper_bound(const geometry::Box3& box, const glm::mat4x3& transform,
                   const glm::dvec3& direction) {
  constexpr double kRounding = 1e-5;  // some dozens of steps of 32-bit floats
  const glm::dmat4x3 exact(transform);
  const glm::dvec3 centre = exact * glm::dvec4(glm::dvec3(box.centre()), 1.0);
  const glm::dvec3 half = glm::dvec3(box.size()) * 0.5;
  double reach = glm::dot(centre, direction), size = 0;
  for (int k = 0; k < 3; ++k) {
    reach += std::abs(glm::dot(exact[k], direction)) * half[k];
    size += glm::length(exact[k]) * std::max(std::abs(box.low[k]), std::abs(box.high[k]));
  }
  return reach + kRounding * glm::length(direction) * (size + glm::length(exact[3]));
}

}  // namespace

void keep_farthest(std::span<const glm::dvec3> directions,
                   const std::vector<glm::dvec3>& candidates, std::vector<glm::dvec3>& farthest) {
  if (farthest.empty()) farthest = candidates;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (farther(directions[i], candidates[i], farthest[i])) farthest[i] = candidates[i];
  }
}

std::vector<glm::dvec3> farthest_corners(const geometry::Box3& box,
                                         std::span<const glm::dvec3> directions) {
  std::vector<glm::dvec3> result;
  if (box.empty()) return result;
  for (const glm::dvec3& d : directions) {
    result.emplace_back(d.x >= 0 ? box.high.x : box.low.x, d.y >= 0 ? box.high.y : box.low.y,
                        d.z >= 0 ? box.high.z : box.low.z);
  }
  return result;
}

geometry::Box3 bounds(const FarthestPoints& farthest) {
  const glm::dvec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  geometry::Box3 box;
  for (const glm::dvec3& p : farthest(axes)) box.include(glm::vec3(p));
  return box;
}

FarthestPoints farthest_points(const Scene& scene) {
  return [&scene, extent = std::shared_ptr<const Extent>()](
             std::span<const glm::dvec3> directions) mutable {
    if (!extent) extent = std::make_shared<const Extent>(scene);
    return (*extent)(directions);
  };
}

Extent::Extent(const Scene& scene) : scene_(scene), meshes_(scene.meshes.size()) {
  parallel::parallel_for(0, meshes_.size(), 1, [&](std::size_t m) {
    const Mesh& mesh = scene.meshes[m];
    Corners& corners = meshes_[m];
    corners.drawn.resize(mesh.positions.size());
    for (const glm::uvec3& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) corners.drawn[t[k]] = 1;
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      if (corners.drawn[i] != 0) corners.box.include(mesh.positions[i]);
    }
    const auto all = std::ranges::find(corners.drawn, 0) == corners.drawn.end();
    if (all) std::vector<std::uint8_t>().swap(corners.drawn);
  });
}

std::vector<glm::dvec3> Extent::within(const Instance& instance,
                                       std::span<const glm::dvec3> directions) const {
  const Mesh& mesh = scene_.meshes[instance.mesh];
  const Corners& corners = meshes_[instance.mesh];
  return parallel::parallel_reduce(
      0, mesh.positions.size(), kVertices, std::vector<glm::dvec3>{},
      [&](std::size_t first, std::size_t last) {
        std::vector<glm::dvec3> farthest;
        std::vector<double> reach(directions.size(), std::numeric_limits<double>::lowest());
        for (std::size_t i = first; i < last; ++i) {
          if (!corners.drawn.empty() && corners.drawn[i] == 0) continue;
          const glm::vec3 placed = instance.transform * glm::vec4(mesh.positions[i], 1.0F);
          if (!scene_.framed.empty() && !contains(scene_.framed, placed)) continue;
          const glm::dvec3 p(placed);
          if (farthest.empty()) farthest.assign(directions.size(), p);
          for (std::size_t k = 0; k < directions.size(); ++k) {
            const double along = glm::dot(p, directions[k]);
            if (along < reach[k] || !farther(directions[k], p, farthest[k])) continue;
            reach[k] = along;
            farthest[k] = p;
          }
        }
        return farthest;
      },
      [&](std::vector<glm::dvec3> a, const std::vector<glm::dvec3>& b) {
        keep_farthest(directions, b, a);
        return a;
      });
}

std::vector<glm::dvec3> Extent::operator()(std::span<const glm::dvec3> directions) const {
  constexpr double kNowhere = std::numeric_limits<double>::lowest();
  const std::vector<Instance>& instances = scene_.instances;
  const std::size_t n = directions.size();
  std::vector<double> bound(instances.size() * n, kNowhere);
  parallel::parallel_for(0, instances.size(), kInstances, [&](std::size_t i) {
    const geometry::Box3& box = meshes_[instances[i].mesh].box;
    for (std::size_t k = 0; k < n && !box.empty(); ++k) {
      bound[i * n + k] = upper_bound(box, instances[i].transform, directions[k]);
    }
  });
  // Instances whose boxes reach farthest come first: hardly any other box reaches as far as their
  // vertices do.
  std::vector<glm::dvec3> farthest;
  std::vector<std::uint8_t> done(instances.size());
  for (std::size_t k = 0; k < n && !instances.empty(); ++k) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < instances.size(); ++i) {
      if (bound[i * n + k] > bound[best * n + k]) best = i;
    }
    if (done[best] != 0) continue;
    done[best] = 1;
    keep_farthest(directions, within(instances[best], directions), farthest);
  }
  const auto may_reach_farther = [&](std::size_t i) {
    for (std::size_t k = 0; k < n; ++k) {
      if (bound[i * n + k] == kNowhere) return false;
      if (farthest.empty() || bound[i * n + k] >= glm::dot(farthest[k], directions[k])) return true;
    }
    return false;
  };
  const auto both = [&](std::vector<glm::dvec3> a, const std::vector<glm::dvec3>& b) {
    keep_farthest(directions, b, a);
    return a;
  };
  return parallel::parallel_reduce(
      0, instances.size(), 1, farthest,
      [&](std::size_t first, std::size_t last) {
        std::vector<glm::dvec3> found;
        for (std::size_t i = first; i < last; ++i) {
          if (done[i] == 0 && may_reach_farther(i)) {
            keep_farthest(directions, within(instances[i], directions), found);
          }
        }
        return found;
      },
      both);
}

}  // namespace delray::scenes
