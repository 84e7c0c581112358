// Walks the tables of strategies, schemes, codecs, partitions and schedules and combines what each
// strategy looks at.
#include "raster/combinations.h"

#include "composite/codec.h"
#include "composite/scheme.h"
#include "loadbalance/partition.h"
#include "loadbalance/schedule.h"
#include "raster/strategies.h"

namespace delray::raster {
namespace {

using Ways = std::vector<RenderOptions>;

void add_compositing(RenderOptions options, Ways& ways) {
  const Shade shade = options.shade;
  for (const composite::Scheme& scheme : composite::schemes()) {
    options.scheme = scheme.name;
    options.shade = shade;
    for (const composite::Codec& codec : composite::codecs()) {
      options.codec = codec.name;
      ways.push_back(options);
    }
    if (options.lighting != Lighting::phong) continue;
    options.shade = Shade::composited;
    ways.push_back(options);
  }
}

void add_partitions_and_schedules(RenderOptions options, Ways& ways) {
  for (const loadbalance::Partitioner& partitioner : loadbalance::partitioners()) {
    options.partition = partitioner.name;
    for (const Travel travel : {Travel::geometry, Travel::numbers}) {
      for (const int regions : {1, 3}) {
        options.travel = travel;
        options.regions_per_rank = regions;
        ways.push_back(options);
      }
    }
    options.regions_per_rank = 1;
    for (const loadbalance::Schedule& schedule : loadbalance::schedules()) {
      options.schedule = schedule.name;
      ways.push_back(options);
    }
    options.schedule.clear();
  }
}

void add_partitions_and_groups(RenderOptions options, Ways& ways) {
  for (const loadbalance::Partitioner& partitioner : loadbalance::partitioners()) {
    for (const Groups groups : {Groups::one, Groups::two}) {
      for (const Redistribution redistribution :
           {Redistribution::at_end, Redistribution::immediate}) {
        options.partition = partitioner.name;
        options.groups = groups;
        options.redistribution = redistribution;
        ways.push_back(options);
      }
    }
  }
}

}  // namespace

Ways combinations(const RenderOptions& base) {
  Ways ways;
  for (const Strategy& strategy : strategies()) {
    RenderOptions options = base;
    options.strategy = strategy.name;
    if (strategy.composites) {
      add_compositing(options, ways);
    } else if (strategy.schedules) {
      add_partitions_and_schedules(options, ways);
    } else if (strategy.groups) {
      add_partitions_and_groups(options, ways);
    } else {
      for (const Travel travel : {Travel::geometry, Travel::numbers}) {
        options.travel = travel;
        ways.push_back(options);
      }
    }
  }
  return ways;
}

std::string name_of(const RenderOptions& options) {
  const std::string travel = options.travel == Travel::numbers ? "/numbers" : "/geometry";
  const Strategy& strategy = *find_strategy(options.strategy);
  if (strategy.composites) {
    return options.strategy + "/" + options.scheme + "/" +
           (options.shade == Shade::composited ? "composited" : options.codec);
  }
  if (strategy.schedules) {
    return options.strategy + "/" + options.partition + travel +
           (options.regions_per_rank > 1 ? "/regions" + std::to_string(options.regions_per_rank)
                                         : "") +
           (options.schedule.empty() ? "" : "/" + options.schedule);
  }
  if (strategy.groups) {
    return options.strategy + "/" + options.partition +
           (options.groups == Groups::two ? "/two-groups" : "/one-group") +
           (options.redistribution == Redistribution::at_end ? "/at-end" : "/immediate");
  }
  return options.strategy + travel;
}

}  // namespace delray::raster
