// Bounds a cluster's box on the screen by interval arithmetic, and tells by its cone of normals
// (Shirman and Abi-Ezzi 1993) whether it shows hidden sides only.
//
// Both allow for rounding and for snapping to subpixels, so that what is dropped would not have
// been drawn. O(1).
//
// Degenerate: a box that reaches before the near plane, or is not a number, may touch all of the
// frame; clusters without a cone, or with triangles that are thinner than some subpixels, are kept.
#include "raster/pipeline/cull.h"

#include <algorithm>
#include <cmath>

namespace delray::raster {
namespace {

// Relative error of a sum of a few products, with a margin.
constexpr float kCullingSlack = 1e-5F;

// Splats reach beyond the box of their centres: in view coordinates, and spots by a margin on the
// screen as their depth does not.
void grow_by_radius(const scenes::View& view, const SplatDraw& splats, glm::vec3& low,
                    glm::vec3& high, float& margin) {
  constexpr float kSlack = 1 + kCullingSlack;
  if (splats.is_spot() || (splats.in_samples && splats.kind == scenes::Shape::Kind::line)) {
    const float nearest = view.orthographic ? 1 : std::max(low.z, view.near);
    const float radius = splats.in_samples ? splats.radius : splats.radius * view.scale / nearest;
    margin = std::min(radius * kSlack, kLargestSplat) + 1;
    return;
  }
  const float radius =
      splats.in_samples ? splats.radius * std::max(high.z, view.near) / view.scale : splats.radius;
  low -= glm::vec3(radius * kSlack);
  high += glm::vec3(radius * kSlack);
}

}  // namespace

ClusterBounds bound(const Screen& screen, const PreparedDraw& draw, const geometry::Box3& box) {
  const glm::vec3 centre = box.centre();
  const glm::vec3 half = box.high - centre;
  glm::vec3 low, high;
  for (int k = 0; k < 3; ++k) {
    const glm::vec4& row = draw.to_view.row[k];
    const glm::vec3 rows(std::abs(row.x), std::abs(row.y), std::abs(row.z));
    const glm::vec3 sizes = glm::abs(centre);
    const float error =
        kCullingSlack * (glm::dot(rows, sizes) + glm::dot(rows, half) + std::abs(row.w));
    const float middle = glm::dot(glm::vec3(row), centre) + row.w;
    const float reach = glm::dot(rows, half) + error;
    low[k] = middle - reach;
    high[k] = middle + reach;
  }

  const scenes::View& view = screen.view;
  float margin = 0;
  if (draw.splats.any()) grow_by_radius(view, draw.splats, low, high, margin);
  ClusterBounds result;
  result.farthest_distance = high.z;
  result.outside = high.z < view.near;
  // Written so that what is not a number takes the side of caution.
  if (!(low.z >= view.near)) {
    result.pixels = screen.frame();
    return result;
  }
  const auto project = [&](float least, float most, float& first, float& last) {
    // The range of value / w over the box.
    const float least_w = view.orthographic ? 1 : low.z, most_w = view.orthographic ? 1 : high.z;
    first = std::min(least / least_w, least / most_w) * view.scale;
    last = std::max(most / least_w, most / most_w) * view.scale;
  };
  float left, right, bottom, top;
  project(low.x, high.x, left, right);
  project(low.y, high.y, bottom, top);
  if (!(left <= right && bottom <= top)) {
    result.pixels = screen.frame();
    return result;
  }
  const auto pixel = [](float position, int size) {
    return static_cast<int>(std::clamp(position, -1.0F, static_cast<float>(size + 1)));
  };
  // A pixel more on each side makes up for rounding and snapping: positions are below 2^16.
  const float around = 1 + margin;
  result.pixels =
      geometry::intersection({pixel(view.half_width + left - around, screen.width),
                              pixel(view.half_height - top - around, screen.height),
                              pixel(view.half_width + right + around, screen.width) + 1,
                              pixel(view.half_height - bottom + around, screen.height) + 1},
                             screen.frame());
  result.outside |= result.pixels.empty();
  const float nearest = view.orthographic
                            ? (low.z - view.far) / (view.far - view.near) - kCullingSlack
                            : -view.near / low.z * (1 + kCullingSlack);
  if (nearest > -1) result.nearest = nearest;
  return result;
}

bool shows_hidden_side_only(const Screen& screen, const PreparedDraw& draw,
                            const MeshCluster& cluster, const ClusterBounds& bounds) {
  if (draw.hidden_side == 0 || !draw.cones || !(cluster.cosine > 0)) return false;
  const glm::vec3 centre = cluster.box.centre();
  const float radius = glm::length(cluster.box.high - centre);
  const glm::vec3 way = centre - draw.eye;
  const float distance = glm::length(way);
  const float along = glm::dot(way, cluster.axis);
  const float across = std::sqrt(std::max(distance * distance - along * along, 0.0F));
  const float sine = std::sqrt(std::max(1 - cluster.cosine * cluster.cosine, 0.0F));
  // A lower bound of dot(n, p - eye) / |p - eye| over all normals n and points p of the cluster.
  const float least = (along * cluster.cosine - across * sine - radius - kCullingSlack * distance) /
                      (distance + radius);
  if (!(least > 0)) return false;
  // Snapping moves a corner by less than a subpixel: it cannot turn a triangle that is everywhere
  // several subpixels wide on the screen.
  constexpr float kSteady = 8;
  const float narrowest = cluster.least_height * draw.scale * least * screen.view.scale *
                          kSubpixels / bounds.farthest_distance;
  return narrowest > kSteady;
}

}  // namespace delray::raster
