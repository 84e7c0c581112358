// Distributed methods of triangulation: one triangulation made by many ranks that exchange
// messages, each with a part of the points.
//
// The methods differ in what they send and in who waits for whom, not in their result. `tiles`
// (tiles.h) is the one to use. The others are those that Kohout (2004) designs in chapter 8 and
// surveys in 5.3, made to be compared with it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/tiles.h"

namespace delray::delaunay {

// A name of distributed_methods(), and what goes with it.
struct DistributedOptions {
  std::string method = "tiles";
  // Cuts space into areas with about as many points, one for each rank that has points: of
  // loadbalance::partitioners(). Methods that cut by themselves have no use for it.
  std::string partition = "kd-split";
  // Its `dim` is that of all; the rest is for what a rank triangulates on its own. `seed` is that
  // of the order of insertion as well; with `statistics`, shared simplices are counted, which takes
  // exchanges of O(simplices) that nothing else counts.
  Options triangulate = {};
};

// What a rank sent and waited for. Counted, except for the seconds.
struct DistributedStatistics {
  std::uint64_t messages = 0, bytes = 0;  // sent to other ranks
  std::uint64_t waits = 0;                // for answers of other ranks to requests
  double waiting_seconds = 0;             // for any message; by the communicator's clock
  std::uint64_t requests = 0;             // messages that ask for simplices of another rank
  std::uint64_t refusals = 0;             // of requests that could have ended in a deadlock
  std::uint64_t rollbacks = 0;            // insertions that were undone and tried again
  std::uint64_t cached_reads = 0;         // that the cache answered
  std::uint64_t points_sent = 0;          // to other ranks, beyond the first distribution
  std::uint64_t shared_simplices = 0;     // whose corners lie in areas of several ranks
};

// A rank's part of the simplices and what it took. `part.tiles` may be empty.
struct DistributedTriangulation {
  TiledTriangulation part;
  DistributedStatistics statistics;
};

// A triangulation that ranks add points to as they arrive. After each insertion all of it is there.
// All calls are collective.
class OnlineTriangulation {
 public:
  virtual ~OnlineTriangulation() = default;
  // Points from any rank; rows are distinct, those of earlier insertions included. The first points
  // decide which area each rank has.
  //
  // Errors: std::invalid_argument on all ranks for a coordinate that is not finite.
  virtual void insert(std::span<const RowPoint> points) = 0;
  // The triangulation of all points so far, as triangulate_distributed() gives it, and what it
  // took.
  virtual DistributedTriangulation extract() = 0;
};

// An entry of the table.
struct DistributedMethod {
  std::string_view name;
  std::string_view description;
  std::vector<int> dims;
  int ranks_without_area = 0;  // where there are more ranks
  // Whether space is cut into areas, all of whose planes and boxes every rank has.
  bool cuts_areas = true;
  // Whether ranks triangulate parts on their own, by DistributedOptions::triangulate.
  bool triangulates_parts = false;
  // What triangulate_distributed() does, for points and options that it has checked.
  DistributedTriangulation (*triangulate)(comm::Communicator& communicator,
                                          std::span<const RowPoint> points,
                                          const DistributedOptions& options);
  // After the run, where the method itself does not count the simplices that it shares.
  std::uint64_t (*count_shared)(comm::Communicator& communicator, std::span<const RowPoint> points,
                                const DistributedOptions& options,
                                const TiledTriangulation& part) = nullptr;
  // Null where all points must be there from the start.
  std::unique_ptr<OnlineTriangulation> (*on_line)(comm::Communicator& communicator,
                                                  const DistributedOptions& options) = nullptr;
};

std::span<const DistributedMethod> distributed_methods();

// The names of those for a dimension, in the order of the table.
std::vector<std::string_view> distributed_methods_for(int dim);

// Collective: the simplices of all ranks together are those that triangulate() gives for the points
// of all ranks, each on one rank. Points may lie on any rank, in any order; rows are distinct.
//
// Errors: as triangulate_tiles(); std::invalid_argument on all ranks for a method that does not
// exist or not in this dimension.
DistributedTriangulation triangulate_distributed(comm::Communicator& communicator,
                                                 std::span<const RowPoint> points,
                                                 const DistributedOptions& options);

// Collective: begins without points. The communicator outlives the result.
//
// Errors: std::invalid_argument on all ranks for options that cannot be, or for a method that needs
// all points from the start.
std::unique_ptr<OnlineTriangulation> make_online_triangulation(comm::Communicator& communicator,
                                                               const DistributedOptions& options);

}  // namespace delray::delaunay
