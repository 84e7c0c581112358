// One signal handler for both signals, with its state in atomics: it may run at any point of the
// program and calls nothing that is not async-signal-safe.
#include "apps/interrupt.h"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace delray::apps {
namespace {

std::atomic<parallel::Progress*> target{nullptr};
std::atomic<std::int64_t> first_signal{0};  // milliseconds of a clock that only runs; 0: none yet

constexpr std::int64_t kSame = 500;  // milliseconds in which a second signal is the first again

// Async-signal-safe.
std::int64_t milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1000000 + 1;
}

extern "C" void request_stop(int signal) {
  const std::int64_t now = milliseconds();
  std::int64_t first = 0;
  if (first_signal.compare_exchange_strong(first, now)) {
    if (parallel::Progress* progress = target.load()) progress->request_stop();
  } else if (now - first >= kSame) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

StopOnInterrupt::StopOnInterrupt(parallel::Progress& progress) {
  target = &progress;
  first_signal = 0;
  std::signal(SIGINT, request_stop);
}

StopOnInterrupt::~StopOnInterrupt() {
  std::signal(SIGINT, SIG_DFL);
  target = nullptr;
}

StopOnTermination::StopOnTermination() { std::signal(SIGTERM, request_stop); }
StopOnTermination::~StopOnTermination() { std::signal(SIGTERM, SIG_DFL); }

}  // namespace delray::apps
