// What the table of distributions is made of.
#pragma once

#include "raytrace/distribution.h"

namespace delray::raytrace {

// Rays that wait for one cluster and go to its owner in one message: enough that the message is
// worth its latency.
inline constexpr std::uint64_t kBatchRays = 256;

RoutingDecision distribute_ray(const WaitingList& waiting);
RoutingDecision distribute_object(const WaitingList& waiting);
RoutingDecision distribute_hybrid(const WaitingList& waiting);
RoutingDecision distribute_by_load(const WaitingList& waiting);

}  // namespace delray::raytrace
