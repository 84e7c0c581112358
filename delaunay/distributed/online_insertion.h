// What the methods share that insert points one after the other: areas, equal points, the first
// simplex, the order of insertion, the result.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "comm/communicator.h"
#include "delaunay/distributed.h"
#include "delaunay/distributed/areas.h"
#include "delaunay/distributed/remote_nodes.h"

namespace delray::delaunay {

// What a method inserts with. All of it outlives the inserter.
template <int D>
struct InsertionSite {
  comm::Communicator& communicator;
  const Areas& areas;
  const FirstSimplex<D>& first;
  parallel::Progress* progress;  // of inserted points; may be null
  DistributedStatistics& statistics;
};

// A method: one object a rank, on all ranks.
template <int D>
class RankInserter {
 public:
  virtual ~RankInserter() = default;
  // Collective: inserts distinct points of this rank's area that are not in yet, in this order if
  // the method does not need another one.
  virtual void insert(std::span<const RowPoint> points) = 0;
  virtual const RemoteNodes<D>& nodes() const = 0;
};

// Makes the inserters of a method, and says how many of the first ranks are to have no area.
struct InsertionMethod {
  std::unique_ptr<RankInserter<2>> (*in_plane)(const InsertionSite<2>& site);
  std::unique_ptr<RankInserter<3>> (*in_space)(const InsertionSite<3>& site);
  int (*spared)(int ranks);
};

std::unique_ptr<OnlineTriangulation> insert_on_line(comm::Communicator& communicator,
                                                    const DistributedOptions& options,
                                                    const InsertionMethod& method);
// All points at once.
DistributedTriangulation insert_all(comm::Communicator& communicator,
                                    std::span<const RowPoint> points,
                                    const DistributedOptions& options,
                                    const InsertionMethod& method);

}  // namespace delray::delaunay
