#include "apps/interrupt.h"

#include <atomic>
#include <csignal>

namespace delray::apps {
namespace {

std::atomic<parallel::Progress*> target{nullptr};

extern "C" void request_stop(int) {
  if (parallel::Progress* progress = target.load()) progress->request_stop();
  std::signal(SIGINT, SIG_DFL);
}

}  // namespace

StopOnInterrupt::StopOnInterrupt(parallel::Progress& progress) {
  target = &progress;
  std::signal(SIGINT, request_stop);
}

StopOnInterrupt::~StopOnInterrupt() {
  std::signal(SIGINT, SIG_DFL);
  target = nullptr;
}

}  // namespace delray::apps
