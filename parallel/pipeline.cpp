#include "parallel/pipeline.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <numeric>

namespace delray::parallel {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

PipelineTimes run_pipeline(std::size_t items, std::size_t slots,
                           std::span<const PipelineStage> stages) {
  PipelineTimes times;
  times.stages.resize(stages.size());
  std::mutex adding;
  // Items leave the last stage in order, so item i + slots enters after item i has left.
  const auto run_stage = [&](std::size_t stage, std::size_t item) {
    const Clock::time_point start = Clock::now();
    tbb::this_task_arena::isolate([&] { stages[stage].run(item, item % slots); });
    const double seconds = since(start);
    const std::lock_guard guard(adding);
    times.stages[stage] += seconds;
  };
  const Clock::time_point start = Clock::now();
#ifdef DELRAY_PLAIN_THREADS
  for (std::size_t item = 0; item < items; ++item) {
    for (std::size_t stage = 0; stage < stages.size(); ++stage) run_stage(stage, item);
  }
#else
  std::size_t next = 0;
  tbb::filter<void, std::size_t> chain = tbb::make_filter<void, std::size_t>(
      tbb::filter_mode::serial_in_order, [&](tbb::flow_control& control) -> std::size_t {
        if (next == items) control.stop();
        return next == items ? 0 : next++;
      });
  for (std::size_t stage = 0; stage < stages.size(); ++stage) {
    const auto mode =
        stages[stage].in_order ? tbb::filter_mode::serial_in_order : tbb::filter_mode::parallel;
    chain &=
        tbb::make_filter<std::size_t, std::size_t>(mode, [&run_stage, stage](std::size_t item) {
          run_stage(stage, item);
          return item;
        });
  }
  const auto leave =
      tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order, [](std::size_t) {});
  tbb::parallel_pipeline(slots, chain & leave);
#endif
  times.seconds = since(start);
  return times;
}

double sequential_seconds(const PipelineTimes& times) {
  return std::accumulate(times.stages.begin(), times.stages.end(), 0.0);
}

double predicted_seconds(const PipelineTimes& times, std::size_t items) {
  if (items == 0) return 0;
  const auto n = static_cast<double>(items);
  const double slowest = *std::max_element(times.stages.begin(), times.stages.end()) / n;
  return sequential_seconds(times) / n + (n - 1) * slowest;
}

}  // namespace delray::parallel
