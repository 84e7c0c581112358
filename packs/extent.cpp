// Support points by branch and bound: pages are looked at in the order in which their boxes reach
// along a direction, until none that is left can reach farther than the best vertex so far.
//
// Degenerate: with Scene::framed boxes outside of it are passed over; a mesh without instances has
// no part in it.
#include "packs/extent.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <unordered_map>

namespace delray::packs {
namespace {

geometry::Box3d placed(const geometry::Box3& box, const glm::mat4x3& transform) {
  // Of a transform that is rounded: some dozens of steps of 32-bit floats more on each side.
  constexpr double kRounding = 1e-5;
  const glm::dmat4x3 exact(transform);
  const glm::dvec3 centre = exact * glm::dvec4(glm::dvec3(box.centre()), 1.0);
  const glm::dvec3 half = glm::dvec3(box.size()) * 0.5;
  glm::dvec3 reach(0.0);
  double size = glm::length(exact[3]);
  for (int k = 0; k < 3; ++k) {
    reach += glm::abs(exact[k]) * half[k];
    size += glm::length(exact[k]) * std::max(std::abs(box.low[k]), std::abs(box.high[k]));
  }
  return {centre - reach - kRounding * size, centre + reach + kRounding * size};
}

bool overlap(const geometry::Box3d& a, const geometry::Box3& b) {
  return glm::all(glm::lessThanEqual(a.low, glm::dvec3(b.high))) &&
         glm::all(glm::lessThanEqual(glm::dvec3(b.low), a.high));
}

class Pages {
 public:
  explicit Pages(const PackReader& pack) : pack_(pack) {
    const scenes::Scene& scene = pack.scene();
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      const scenes::Instance& instance = scene.instances[i];
      const PageRange& range = pack.meshes()[instance.mesh].levels.front();
      for (std::uint32_t page = range.first; page < range.first + range.count; ++page) {
        const geometry::Box3d box = placed(pack.pages()[page].box, instance.transform);
        if (scene.framed.empty() || overlap(box, scene.framed)) placed_.push_back({i, page, box});
      }
    }
  }

  std::vector<glm::dvec3> farthest(std::span<const glm::dvec3> directions) {
    std::vector<glm::dvec3> result;
    for (std::size_t k = 0; k < directions.size(); ++k) look_along(directions, k, result);
    pages_.clear();
    return result;
  }

 private:
  struct Placed {
    std::uint32_t instance, page;
    geometry::Box3d box;
  };

  // Improves all directions by the pages that may reach farthest along one of them.
  void look_along(std::span<const glm::dvec3> directions, std::size_t k,
                  std::vector<glm::dvec3>& farthest) {
    const glm::dvec3& direction = directions[k];
    std::vector<std::pair<double, std::uint32_t>> order;  // a heap
    order.reserve(placed_.size());
    for (std::uint32_t i = 0; i < placed_.size(); ++i) {
      const geometry::Box3d& box = placed_[i].box;
      const glm::dvec3 corner(direction.x >= 0 ? box.high.x : box.low.x,
                              direction.y >= 0 ? box.high.y : box.low.y,
                              direction.z >= 0 ? box.high.z : box.low.z);
      const double reach = glm::dot(corner, direction);
      if (!farthest.empty() && reach < glm::dot(farthest[k], direction)) continue;
      order.emplace_back(reach, i);
    }
    std::make_heap(order.begin(), order.end());
    while (!order.empty()) {
      const auto [reach, i] = order.front();
      if (!farthest.empty() && reach < glm::dot(farthest[k], direction)) break;
      std::pop_heap(order.begin(), order.end());
      order.pop_back();
      scenes::keep_farthest(directions, of_page(placed_[i], directions), farthest);
    }
  }

  // Every vertex of a page has a triangle.
  std::vector<glm::dvec3> of_page(const Placed& placed, std::span<const glm::dvec3> directions) {
    const scenes::Scene& scene = pack_.scene();
    const glm::mat4x3& transform = scene.instances[placed.instance].transform;
    const auto [known, is_new] = pages_.try_emplace(placed.page);
    if (is_new) known->second = pack_.read(placed.page).mesh.positions;
    std::vector<glm::dvec3> farthest;
    for (const glm::vec3& position : known->second) {
      const glm::vec3 p = transform * glm::vec4(position, 1.0F);
      const geometry::Box3& framed = scene.framed;
      if (!framed.empty() && !(glm::all(glm::lessThanEqual(framed.low, p)) &&
                               glm::all(glm::lessThanEqual(p, framed.high))))
        continue;
      scenes::keep_farthest(directions, std::vector<glm::dvec3>(directions.size(), glm::dvec3(p)),
                            farthest);
    }
    return farthest;
  }

  const PackReader& pack_;
  std::vector<Placed> placed_;
  std::unordered_map<std::uint32_t, std::vector<glm::vec3>> pages_;  // that were read
};

}  // namespace

scenes::FarthestPoints farthest_points(const PackReader& pack) {
  return [&pack, pages = std::shared_ptr<Pages>()](std::span<const glm::dvec3> directions) mutable {
    if (!pages) pages = std::make_shared<Pages>(pack);
    return pages->farthest(directions);
  };
}

}  // namespace delray::packs
