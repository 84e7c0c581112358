// Ctrl-C, and being told to end (SIGTERM) by a launcher or a batch system.
#pragma once

#include "parallel/progress.h"

namespace delray::apps {

// While it lives, the first of these signals asks `progress` to stop; another one, at least half a
// second later, ends the program at once. (Wrappers and groups of processes may hand on one signal
// twice.) One at a time in a process: a signal has one handler.
class StopOnInterrupt {
 public:
  explicit StopOnInterrupt(parallel::Progress& progress);
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
};

}  // namespace delray::apps
