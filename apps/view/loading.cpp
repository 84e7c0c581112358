// One thread loads, another tells how far it is; what there is is handed over under a lock.
#include "apps/view/loading.h"

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
          const std::uint64_t done = progress.done(), total = progress.total();
          // Of what comes after all is read nobody knows how long it takes.
          const bool loads = total == 0 || done < total;
          viewers.set_progress(loads ? "Loading" : "Building", loads ? done : 0, loads ? total : 0);
        } while (!never_.wait_for(lock, stop, kBetween, [] { return false; }) &&
                 !stop.stop_requested());
      }) {}

Loading::Loading(Viewers& viewers, int workers, const parallel::Progress& stop)
    : viewers_(viewers),
      progress_(&stop),
      request_(viewers.request_of(viewers.begin_loading())),
      thread_([this, workers] { load(workers); }) {}

Loading::~Loading() { progress_.request_stop(); }

void Loading::load(int workers) {
  try {
    const parallel::AllowThreads allowed(workers);
    parallel::Arena arena(workers);
    Loaded loaded;
    loaded.is_whole = true;
    {
      const ReportLoading report(viewers_, progress_);
      PrepareOptions options;
      options.keep_points = true;
      // Some of a scene is not posed.
      if (request_.motion.pose_time.empty())
        options.preview = [&](scenes::Scene&& some) { show(std::move(some)); };
      loaded.prepared = arena.execute([&] { return prepare(request_, &progress_, options); });
    }
    loaded.facts = arena.execute(
        [&] { return std::make_shared<const Json>(facts_of(request_, *loaded.prepared)); });
    const std::scoped_lock lock(mutex_);
    whole_ = std::move(loaded);
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    failure_ = std::current_exception();
  }
  end();
}

void Loading::show(scenes::Scene&& some) {
  RenderRequest plain = request_;
  plain.legend = false;
  if (plain.light.is_picture()) plain.light = {};  // which may take long to read
  Loaded part;
  part.prepared = prepare(plain, std::move(some));
  part.prepared->is_preview = true;
  part.facts = std::make_shared<const Json>(facts_of(plain, *part.prepared));
  const std::scoped_lock lock(mutex_);
  part_ = std::move(part);
  changed_.notify_all();
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
