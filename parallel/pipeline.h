// Functional parallelism: a sequence of stages that every item passes through, different items in
// different stages at the same time.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace delray::parallel {

// A step that every item of a pipeline passes.
struct PipelineStage {
  std::string name;
  // One item at a time, in ascending order; otherwise several items at once, in any order.
  bool in_order = true;
  // `slot` is below the number of slots, and no other item has it meanwhile: for memory that is
  // used again. Loops inside a stage run in the same arena, but never steal work of other stages.
  std::function<void(std::size_t item, std::size_t slot)> run;
};

// How long the stages of a pipeline worked.
struct PipelineTimes {
  std::vector<double> stages;  // seconds, summed over items
  double seconds = 0;          // from the first item's start to the last one's end
};

// Passes the items 0 .. items - 1 through all stages, at most `slots` of them at once: with one
// slot one after the other. What a stage throws ends the pipeline, once the stages under way are
// done, and is thrown here. In the arena that the caller is in.
//
// REQUIRES: slots >= 1; there are stages.
PipelineTimes run_pipeline(std::size_t items, std::size_t slots,
                           std::span<const PipelineStage> stages);

// One after the other the items would take the sum of the stages; in a pipeline with a processor
// for every stage, whose slowest sets the pace, sum + (items - 1) * slowest of an item (Kohout
// 2004, 2.1 and 2.2). Both for stages that take the same time for every item.
double sequential_seconds(const PipelineTimes& times);
double predicted_seconds(const PipelineTimes& times, std::size_t items);

}  // namespace delray::parallel
