// How rays and geometry come together where no rank has the whole scene.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "raytrace/shared_scene.h"

namespace delray::raytrace {

// Options of a rank that has put rays aside for a cluster of another rank.
enum class RoutingDecision : std::uint8_t { wait, send_rays, fetch_cluster };

// Rays that wait for one cluster, as the decision sees them.
struct WaitingList {
  std::uint32_t cluster = 0;
  std::uint64_t rays = 0, ray_bytes = 0;  // that wait
  std::uint64_t cluster_bytes = 0;        // that would travel instead
  // Rays that wait for it or were sent to its owner, in this frame and, by halves, in those before,
  // and what it took lately, in seconds, to send a ray and have its answer, and to fetch so large a
  // cluster and build its acceleration structure.
  double wanted = 0.0, ray_seconds = 0.0, cluster_seconds = 0.0;
  bool has_room = false;  // in the cache, without a cluster having to go
  // Rays that have not been intersected: on this rank, on the cluster's owner, and on the rank that
  // has fewest, as they said with their last messages.
  std::uint64_t own_load = 0, owner_load = 0, least_load = 0;
  bool idle = false;  // the rank has nothing else to do
};

// An entry of the table of distributions of a scene.
struct Distribution {
  const char* name;
  const char* description;
  // Null: rays go round all ranks instead, each of which tests them against what it has.
  RoutingDecision (*decide)(const WaitingList& waiting);
  // Whether every rank has the whole scene, and nothing of this takes place.
  bool replicated = false;
  bool fetches = false;  // clusters of other ranks, into ShareOptions::cache_bytes
  // Whether rays may travel instead, so that clusters are only fetched which are worth it, and make
  // room between frames for others that are worth more.
  bool chooses = false;
  // Whether ranks that have less than an equal share trace tiles of the others, and by how much of
  // a share one must have more: by the more where what rays need does not come to them, but rays
  // travel instead.
  bool plans_tiles = false;
  double uneven = 0.0;
  // Whether every message says how many rays its sender has to intersect.
  bool tells_loads = false;
  // How the scene is divided, for share_options().
  ShareOptions::Division division = ShareOptions::Division::clusters;
  bool compresses = false;  // clusters that are fetched

  // Whether clusters may be pages of a pack (SharedScene::of_pack).
  bool reads_packs() const {
    return fetches && !chooses && !tells_loads && division == ShareOptions::Division::clusters;
  }
};

// The options with what the distribution says of them.
ShareOptions share_options(const Distribution& distribution, ShareOptions options = {});

// The table: command line, tests and benchmarks iterate over it.
std::span<const Distribution> distributions();
const Distribution* find_distribution(std::string_view name);  // nullptr when there is none

}  // namespace delray::raytrace
