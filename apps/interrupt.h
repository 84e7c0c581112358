// Ctrl-C, and being told to end (SIGTERM) by a launcher or a batch system.
#pragma once

#include "parallel/progress.h"

namespace delray::apps {

// While it lives, the first SIGINT asks `progress` to stop; another signal, at least half a second
// later, ends the program at once. (Wrappers and groups of processes may hand on one signal twice.)
// One at a time in a process: a signal has one handler.
class StopOnInterrupt {
 public:
  explicit StopOnInterrupt(parallel::Progress& progress);
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
};

// While it lives, within the life of the other one, SIGTERM does the same: for work that has
// something to keep, and looks often whether it should stop.
class StopOnTermination {
 public:
  StopOnTermination();
  ~StopOnTermination();
  StopOnTermination(const StopOnTermination&) = delete;
  StopOnTermination& operator=(const StopOnTermination&) = delete;
};

}  // namespace delray::apps
