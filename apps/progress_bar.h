// The bar on a terminal.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "apps/session.h"

namespace delray::apps {

// Shows session.progress on stderr while it lives, from the second second on; only on a terminal,
// only by the first process, never when quiet.
class ProgressBar {
 public:
  ProgressBar(Session& session, std::string what);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

 private:
  void draw_until_done();

  parallel::Progress& progress_;
  std::string what_;
  std::mutex mutex_;
  std::condition_variable done_changed_;
  bool done_ = false, drawn_ = false;
  std::thread thread_;
};

}  // namespace delray::apps
