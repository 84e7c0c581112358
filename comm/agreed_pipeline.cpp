// Wraps the stages of a pipeline: a stage that throws records its exception and lets later items
// pass without work, and the collective stage makes all ranks agree on a failure before each item.
#include "comm/agreed_pipeline.h"

#include <cassert>
#include <exception>
#include <mutex>
#include <utility>
#include <vector>

#include "comm/agree_on_failure.h"

namespace delray::comm {

parallel::PipelineTimes run_agreed_pipeline(Communicator& communicator, std::size_t items,
                                            std::size_t slots,
                                            std::span<const parallel::PipelineStage> stages,
                                            std::size_t collective, Phase phase) {
  assert(collective < stages.size() && stages[collective].in_order);
  std::mutex mutex;
  std::exception_ptr failure;
  const auto failure_so_far = [&] {
    const std::lock_guard lock(mutex);
    return failure;
  };
  const auto agree = [&] {
    const std::exception_ptr mine = failure_so_far();
    if (mine && communicator.size() == 1) std::rethrow_exception(mine);
    agree_on_failure(communicator, mine, phase);
  };
  std::vector<parallel::PipelineStage> guarded(stages.begin(), stages.end());
  for (std::size_t k = 0; k < guarded.size(); ++k) {
    auto run = std::move(guarded[k].run);
    if (k == collective) {
      guarded[k].run = [&, run = std::move(run)](std::size_t item, std::size_t slot) {
        agree();
        run(item, slot);
      };
    } else {
      guarded[k].run = [&, run = std::move(run)](std::size_t item, std::size_t slot) {
        if (failure_so_far()) return;
        try {
          run(item, slot);
        } catch (const std::exception&) {
          const std::lock_guard lock(mutex);
          if (!failure) failure = std::current_exception();
        }
      };
    }
  }
  parallel::PipelineTimes times = parallel::run_pipeline(items, slots, guarded);
  agree();
  return times;
}

}  // namespace delray::comm
