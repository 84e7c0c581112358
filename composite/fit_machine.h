// A model of a machine from how long compositing took on it.
#pragma once

#include <span>
#include <string>

#include "composite/simulate.h"

namespace delray::composite {

// A scheme that was run and took so long, without the gather.
struct TimedScheme {
  std::string scheme;
  MetadataOnlyImages images;
  double seconds = 0;
  double weight = 1;  // how much it counts
  ComposeOptions options = {};
};

// `start` with overhead and latency of messages, the costs of cutting and those of merging scaled,
// each by a factor of at most 30 up or down, so that simulated and measured times agree: least
// squares of the logarithms, of what lies far off only the direction, with a light pull towards
// `start`. Some twenty simulations of each sample. `start` itself where there are no samples.
//
// REQUIRES: seconds > 0, weight >= 0; all samples have one codec, that of start.costs.
MachineModel fit_machine(const MachineModel& start, std::span<const TimedScheme> samples);

}  // namespace delray::composite
