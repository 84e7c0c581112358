// Phases and counts of a triangulation under the names of docs/delaunay.md.
#include "apps/triangulation_json.h"

namespace delray::apps {
namespace {

Json lengths_json(const delaunay::ListLengths& lengths) {
  return {{"lists", lengths.lists}, {"entries", lengths.entries}, {"longest", lengths.longest}};
}

}  // namespace

Json phases_json(const delaunay::Statistics& statistics) {
  return {{"order", statistics.order},
          {"locate", statistics.locate},
          {"subdivide", statistics.subdivide},
          {"legalize", statistics.legalize},
          {"extract", statistics.extract}};
}

Json flips_json(const delaunay::FlipCounts& flips, int dim) {
  if (dim == 2) return {{"2-2", flips.two_two}};
  return {{"2-2", flips.two_two},
          {"2-3", flips.two_three},
          {"3-2", flips.three_two},
          {"4-4", flips.four_four}};
}

Json synchronization_json(const delaunay::Synchronization& synchronization) {
  return {{"lock_calls", synchronization.lock_calls},
          {"already_locked", synchronization.already_locked},
          {"free", synchronization.free},
          {"waits", synchronization.waits},
          {"unlocked_early", synchronization.unlocked_early},
          {"deadlocks", synchronization.deadlocks},
          {"rollbacks", synchronization.rollbacks},
          {"burglaries", synchronization.burglaries},
          {"repaired", synchronization.repaired},
          {"rebuilds", synchronization.rebuilds},
          {"fragments", synchronization.fragments},
          {"mutex_locks", synchronization.mutex_locks},
          {"mutex_waits", synchronization.mutex_waits},
          {"mutex_bytes", synchronization.mutex_bytes},
          {"journals", lengths_json(synchronization.journals)},
          {"lock_lists", lengths_json(synchronization.lock_lists)}};
}

Json searching_json(const std::vector<delaunay::SearchingThreads>& searching) {
  Json result = Json::array();
  for (const auto& [inserted, threads] : searching) {
    result.push_back({{"inserted", inserted}, {"threads", threads}});
  }
  return result;
}

}  // namespace delray::apps
