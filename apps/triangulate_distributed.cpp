// Shares rows out to ranks and adds up on rank 0 what a distributed method counted on each.
#include "apps/triangulate_distributed.h"

#include <span>

#include "comm/collectives.h"

namespace delray::apps {

using delaunay::DistributedStatistics;

DistributedRun gather_run(comm::Communicator& communicator,
                          const delaunay::DistributedTriangulation& mine, bool with_vertices) {
  DistributedRun run;
  run.made = gather_parts(communicator, mine.part, with_vertices);
  for (const comm::Buffer& each :
       comm::gather(communicator, 0, comm::Buffer::of_value(mine.statistics))) {
    const auto received = each.as<DistributedStatistics>();
    run.ranks.insert(run.ranks.end(), received.begin(), received.end());
  }
  return run;
}

DistributedRun triangulate_by_method(comm::Communicator& communicator,
                                     const delaunay::PointCloud& points,
                                     const delaunay::DistributedOptions& options,
                                     bool with_vertices) {
  return gather_run(
      communicator,
      delaunay::triangulate_distributed(communicator, own_rows(communicator, points), options),
      with_vertices);
}

DistributedStatistics sum_of(const std::vector<DistributedStatistics>& ranks) {
  DistributedStatistics sum;
  for (const DistributedStatistics& rank : ranks) {
    sum.messages += rank.messages;
    sum.bytes += rank.bytes;
    sum.waits += rank.waits;
    sum.waiting_seconds += rank.waiting_seconds;
    sum.requests += rank.requests;
    sum.refusals += rank.refusals;
    sum.rollbacks += rank.rollbacks;
    sum.cached_reads += rank.cached_reads;
    sum.points_sent += rank.points_sent;
    sum.shared_simplices += rank.shared_simplices;
  }
  return sum;
}

Json counts_json(const DistributedStatistics& counts) {
  return {{"messages", counts.messages},
          {"bytes", counts.bytes},
          {"waits", counts.waits},
          {"waiting_seconds", counts.waiting_seconds},
          {"requests", counts.requests},
          {"refusals", counts.refusals},
          {"rollbacks", counts.rollbacks},
          {"cached_reads", counts.cached_reads},
          {"points_sent", counts.points_sent},
          {"shared_simplices", counts.shared_simplices}};
}

Json distributed_json(const delaunay::DistributedOptions& options, const DistributedRun& run) {
  Json result = counts_json(sum_of(run.ranks));
  result["method"] = options.method;
  Json& ranks = result["ranks"] = Json::array();
  for (const DistributedStatistics& rank : run.ranks) ranks.push_back(counts_json(rank));
  return result;
}

}  // namespace delray::apps
