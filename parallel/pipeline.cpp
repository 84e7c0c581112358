// A pipeline over oneTBB's parallel_pipeline, or plain threads under ThreadSanitizer, with times
// and predictions (Kohout 2004, 2.1 and 2.2).
//
// Each stage is a filter, in order or parallel. A last filter in order makes items leave as they
// entered, so item i + slots cannot enter before item i has left, and i modulo slots is a slot of
// its own. Loops of a stage run isolated, in a task context of their own.
//
// Degenerate: without items nothing runs; with one slot items pass one after the other.
#include "parallel/pipeline.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <numeric>
#include <thread>

#include "parallel/threads/plain_threads.h"

namespace delray::parallel {
namespace {

using Clock = std::chrono::steady_clock;

// In a context of its own: the pipeline's is cancelled by an exception, and loops within would then
// return with half of their work undone.
void run_whole(const PipelineStage& stage, std::size_t item, std::size_t slot) {
#ifdef DELRAY_TSAN
  stage.run(item, slot);
#else
  tbb::task_group_context own(tbb::task_group_context::isolated);
  tbb::task_group group(own);
  tbb::this_task_arena::isolate([&] { group.run_and_wait([&] { stage.run(item, slot); }); });
#endif
}

#ifdef DELRAY_TSAN
// A thread for each slot takes every slots-th item through all stages.
template <class RunStage>
void run_on_threads(std::size_t items, std::size_t slots, std::span<const PipelineStage> stages,
                    RunStage&& run_stage) {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::size_t> turn(stages.size());  // which item an in-order stage takes next
  std::exception_ptr error;
  const auto pass = [&](std::size_t item) {
    for (std::size_t stage = 0; stage < stages.size(); ++stage) {
      if (stages[stage].in_order) {
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return error || turn[stage] == item; });
        if (error) return;
      }
      run_stage(stage, item);
      const std::lock_guard lock(mutex);
      if (stages[stage].in_order) ++turn[stage];
      changed.notify_all();
    }
  };
  std::vector<std::jthread> threads;
  for (std::size_t slot = 0; slot < std::min(slots, items); ++slot) {
    threads.emplace_back([&, slot] {
      for (std::size_t item = slot; item < items; item += slots) {
        try {
          pass(item);
        } catch (...) {
          const std::lock_guard lock(mutex);
          if (!error) error = std::current_exception();
          changed.notify_all();
        }
        const std::lock_guard lock(mutex);
        if (error) return;
      }
    });
  }
  threads.clear();
  if (error) std::rethrow_exception(error);
}
#endif

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

PipelineTimes run_pipeline(std::size_t items, std::size_t slots,
                           std::span<const PipelineStage> stages) {
  PipelineTimes times;
  times.stages.resize(stages.size());
  std::mutex adding;
  // Items leave the pipeline in order, so item i + slots enters after item i has left.
  const auto run_stage = [&](std::size_t stage, std::size_t item) {
    const Clock::time_point start = Clock::now();
    run_whole(stages[stage], item, item % slots);
    const double seconds = since(start);
    const std::lock_guard guard(adding);
    times.stages[stage] += seconds;
  };
  const Clock::time_point start = Clock::now();
#ifdef DELRAY_TSAN
  run_on_threads(items, slots, stages, run_stage);
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
