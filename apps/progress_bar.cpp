#include "apps/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace delray::apps {
namespace {

using std::chrono::duration;
using std::chrono::steady_clock;
constexpr std::chrono::milliseconds kQuietTime{1000}, kRedraw{100};
constexpr int kWidth = 30;

std::string bar(const std::string& what, std::uint64_t done, std::uint64_t total, double seconds) {
  if (total == 0) return fmt::format("\r{}: {}  {:.0f} s ", what, done, seconds);
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  const int full = static_cast<int>(share * kWidth);
  const double left = share > 0 ? seconds * (1 - share) / share : 0;
  return fmt::format("\r{}: [{:#<{}}{:.<{}}] {:3.0f} %  {:.0f} s left ", what, "", full, "",
                     kWidth - full, 100 * share, left);
}

}  // namespace

ProgressBar::ProgressBar(Session& session, std::string what)
    : progress_(session.progress), what_(std::move(what)) {
  progress_.start(0);
  if (session.quiet || !session.first_process || ::isatty(STDERR_FILENO) == 0) return;
  thread_ = std::thread([this] { draw_until_done(); });
}

ProgressBar::~ProgressBar() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  done_changed_.notify_one();
  thread_.join();
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::draw_until_done() {
  const auto start = steady_clock::now();
  std::unique_lock lock(mutex_);
  if (done_changed_.wait_for(lock, kQuietTime, [this] { return done_; })) return;
  do {
    const double seconds = duration<double>(steady_clock::now() - start).count();
    std::fputs(bar(what_, progress_.done(), progress_.total(), seconds).c_str(), stderr);
    std::fflush(stderr);
    drawn_ = true;
  } while (!done_changed_.wait_for(lock, kRedraw, [this] { return done_; }));
}

}  // namespace delray::apps
