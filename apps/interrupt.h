// Ctrl-C.
#pragma once

#include "parallel/progress.h"

namespace delray::apps {

// While it lives, the first SIGINT asks `progress` to stop; a second one ends the program at once.
// One at a time in a process: the signal has one handler.
class StopOnInterrupt {
 public:
  explicit StopOnInterrupt(parallel::Progress& progress);
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
};

}  // namespace delray::apps
