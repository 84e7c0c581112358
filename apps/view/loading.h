// A scene that is loaded beside whoever shows what there is of it so far.
#pragma once

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "apps/render/prepare.h"
#include "apps/view/viewers.h"
#include "parallel/progress.h"

namespace delray::apps::view {

// Tells pages how far loading is while it lives.
class ReportLoading {
 public:
  ReportLoading(Viewers& viewers, const parallel::Progress& progress);

 private:
  std::mutex mutex_;
  std::condition_variable_any never_;
  std::jthread thread_;
};

// Loads as pages ask for now, on a thread of its own and workers, and tells pages how far it is.
class Loading {
 public:
  // `stop` ends it, and outlives it as `viewers` does. Throws UsageError as make_request.
  Loading(Viewers& viewers, int workers, const parallel::Progress& stop);
  ~Loading();  // ends it
  Loading(const Loading&) = delete;
  Loading& operator=(const Loading&) = delete;

  struct Loaded {
    std::shared_ptr<Prepared> prepared;
    std::shared_ptr<const Json> facts;  // for pages: facts_of
    // Else some of it, and `viewers` will have a task when the rest is there.
    bool is_whole = false;
  };
  // Waits for a part of it that can be shown, or for all. Throws what loading throws.
  Loaded first();
  // Waits for all.
  Loaded whole();

 private:
  void load(int workers);
  void show(scenes::Scene&& some);
  void end();

  Viewers& viewers_;
  parallel::Progress progress_;
  RenderRequest request_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Loaded part_, whole_;
  std::exception_ptr failure_;
  bool is_done_ = false, was_part_taken_ = false;
  std::jthread thread_;
};

}  // namespace delray::apps::view
