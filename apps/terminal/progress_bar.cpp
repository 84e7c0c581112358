// The bar on a terminal: a thread draws it, ten times a second.
#include "apps/terminal/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>

#include "apps/terminal/progress_text.h"
#include "apps/terminal/terminal.h"

namespace delray::apps {
namespace {

using std::chrono::duration;
using std::chrono::steady_clock;
constexpr std::chrono::milliseconds kQuietTime{1000}, kRedraw{100};
constexpr std::string_view kClear = "\r\x1b[K";

std::atomic<bool> is_drawn{false};

// Follows tasks that begin one after the other: each is timed by itself.
class TaskWatch {
 public:
  explicit TaskWatch(parallel::Progress& progress) : progress_(progress) {}

  TaskState look() {
    const std::uint64_t done = progress_.done(), total = progress_.total();
    if (done < last_done_) start_ = steady_clock::now();
    last_done_ = done;
    return {done, total, duration<double>(steady_clock::now() - start_).count()};
  }

 private:
  parallel::Progress& progress_;
  steady_clock::time_point start_ = steady_clock::now();
  std::uint64_t last_done_ = 0;
};

// In one call, so that it does not mix with a line of text.
void put(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

ProgressBar::ProgressBar(Session& session, std::string what)
    : progress_(session.progress), what_(std::move(what)) {
  progress_.start(0);
  if (session.quiet || !session.first_process || ::isatty(STDERR_FILENO) == 0) return;
  thread_ = std::thread([this] { draw_until_done(); });
}

void ProgressBar::end() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  done_changed_.notify_one();
  thread_.join();
  if (is_drawn.exchange(false)) put(std::string(kClear));
}

void ProgressBar::draw_until_done() {
  TaskWatch watch(progress_);
  std::unique_lock lock(mutex_);
  if (done_changed_.wait_for(lock, kQuietTime, [this] { return done_; })) return;
  is_drawn = true;
  do {
    const std::size_t width = line_width(STDERR_FILENO) - 1;  // the cursor is in the last column
    put(std::string(kClear) + progress_text(what_, watch.look(), width));
  } while (!done_changed_.wait_for(lock, kRedraw, [this] { return done_; }));
}

std::string_view before_line() { return is_drawn ? kClear : std::string_view(); }

}  // namespace delray::apps
