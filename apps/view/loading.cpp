// One thread loads, another tells how far it is; what there is is handed over under a lock.
#include "apps/view/loading.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

#include "apps/view/serve.h"
#include "parallel/arena.h"

namespace delray::apps::view {

ReportLoading::ReportLoading(Viewers& viewers, const parallel::Progress& progress)
    : thread_([this, &viewers, &progress](const std::stop_token& stop) {
        constexpr std::chrono::milliseconds kBetween{200};
        std::unique_lock lock(mutex_);
        do {
          viewers.set_progress("Loading", progress.done(), progress.total());
        } while (!never_.wait_for(lock, stop, kBetween, [] { return false; }) &&
                 !stop.stop_requested());
      }) {}

Loading::Loading(Viewers& viewers, int workers, const parallel::Progress& stop)
    : viewers_(viewers), progress_(&stop), thread_([this, workers] { load(workers); }) {}

Loading::~Loading() { progress_.request_stop(); }

void Loading::load(int workers) {
  try {
    const RenderRequest request = viewers_.shared_request();
    const parallel::AllowThreads allowed(workers);
    parallel::Arena arena(workers);
    Loaded loaded;
    loaded.is_whole = true;
    {
      const ReportLoading report(viewers_, progress_);
      PrepareOptions options;
      options.keep_points = true;
      options.preview = [&](scenes::Scene&& some) { show(request, std::move(some)); };
      loaded.prepared = arena.execute([&] { return prepare(request, &progress_, options); });
    }
    loaded.facts = arena.execute([&] { return facts_of(request, *loaded.prepared); });
    const std::scoped_lock lock(mutex_);
    whole_ = std::move(loaded);
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    failure_ = std::current_exception();
  }
  end();
}

// Of a preview nobody depends: all of the scene says what is wrong.
void Loading::show(const RenderRequest& request, scenes::Scene&& some) {
  try {
    RenderRequest plain = request;
    plain.legend = false;
    Loaded part;
    part.prepared = prepare(plain, std::move(some));
    part.facts = facts_of(plain, *part.prepared);
    const std::scoped_lock lock(mutex_);
    part_ = std::move(part);
    changed_.notify_all();
  } catch (const std::exception& error) {
    spdlog::debug("no preview: {}", error.what());
  }
}

void Loading::end() {
  bool is_awaited = false;
  {
    const std::scoped_lock lock(mutex_);
    is_done_ = true;
    is_awaited = was_part_taken_;
    changed_.notify_all();
  }
  if (is_awaited) viewers_.scene_is_there();
}

Loading::Loaded Loading::first() {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_done_ || part_.prepared; });
    if (!is_done_) {
      was_part_taken_ = true;
      return std::exchange(part_, {});
    }
  }
  return whole();
}

Loading::Loaded Loading::whole() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return is_done_; });
  if (failure_) std::rethrow_exception(failure_);
  return std::exchange(whole_, {});
}

}  // namespace delray::apps::view
