// Phases and counts of a triangulation under the names of docs/delaunay.md.
#include "apps/triangulation_json.h"

namespace delray::apps {

Json phases_json(const delaunay::Statistics& statistics) {
  return {{"order", statistics.order},
          {"locate", statistics.locate},
          {"subdivide", statistics.subdivide},
          {"legalize", statistics.legalize},
          {"extract", statistics.extract}};
}

Json synchronization_json(const delaunay::Synchronization& synchronization) {
  return {{"lock_calls", synchronization.lock_calls},
          {"already_locked", synchronization.already_locked},
          {"free", synchronization.free},
          {"waits", synchronization.waits},
          {"deadlocks", synchronization.deadlocks},
          {"rollbacks", synchronization.rollbacks},
          {"burglaries", synchronization.burglaries},
          {"repaired", synchronization.repaired},
          {"rebuilds", synchronization.rebuilds},
          {"fragments", synchronization.fragments}};
}

}  // namespace delray::apps
