// Asks for the first boxes of clusters in the way of rays through a tile, and takes the rank that
// most of them belong to: there most of the rays need not travel (Badouel et al. 1990 give pixels
// to processors by the data that they need).
//
// Degenerate: boxes may be passed without a hit, so another rank may be the better one; that costs
// time and changes no pixel.
#include "raytrace/distributed/tile_owners.h"

#include <algorithm>
#include <array>
#include <limits>

namespace delray::raytrace {
namespace {

// Places in a tile, as shares of its sides.
constexpr std::array<glm::vec2, 5> kPlaces = {
    {{0.5F, 0.5F}, {0.25F, 0.25F}, {0.75F, 0.25F}, {0.25F, 0.75F}, {0.75F, 0.75F}}};

constexpr int kNone = -1;

int owner_at(const scenes::View& view, const SharedScene& scene, int rank, float x, float y) {
  const glm::vec3 direction = view.ray(x, y);
  const Line line{view.origin(x, y), glm::vec3(1.0F) / direction, view.near,
                  std::numeric_limits<float>::infinity()};
  const ClusterHit hit = scene.everywhere().next(line, {-1.0F, 0});
  if (hit.cluster == kNoCluster) return kNone;
  return scene.is_resident(hit.cluster) ? rank : scene.owner(hit.cluster);
}

}  // namespace

int owner_of_tile(const TiledFrame& frame, const SharedScene& scene, int rank, std::uint32_t tile) {
  const geometry::Rect rect = frame.tiles.block(tile);
  std::array<int, kPlaces.size()> owners{};
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    const float x = static_cast<float>(rect.x0) + kPlaces[i].x * static_cast<float>(rect.width());
    const float y = static_cast<float>(rect.y0) + kPlaces[i].y * static_cast<float>(rect.height());
    owners[i] = owner_at(frame.context.view, scene, rank, x, y);
  }
  const auto votes = [&](int owner) { return std::count(owners.begin(), owners.end(), owner); };
  int best = rank;
  for (const int owner : owners)
    if (owner != kNone && votes(owner) > votes(best)) best = owner;
  return best;
}

}  // namespace delray::raytrace
