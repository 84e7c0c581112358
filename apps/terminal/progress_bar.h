// The bar on a terminal.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "apps/session.h"

namespace delray::apps {

// Shows session.progress on stderr while it lives, from the second second on; only on a terminal,
// only by the first process, never when quiet. One at a time.
class ProgressBar {
 public:
  ProgressBar(Session& session, std::string what);
  ~ProgressBar() { end(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // Takes the bar away, so that results have lines of their own.
  void end();

 private:
  void draw_until_done();

  parallel::Progress& progress_;
  std::string what_;
  std::mutex mutex_;
  std::condition_variable done_changed_;
  bool done_ = false;
  std::thread thread_;
};

// The text to write to stderr before a line: clears the bar if one is drawn, else nothing.
std::string_view before_line();

}  // namespace delray::apps
