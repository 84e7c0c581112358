// Ranks that are threads of this process.
#pragma once

#include <chrono>
#include <functional>

#include "comm/communicator.h"
#include "comm/failure.h"

namespace delray::comm {

struct ThreadsOptions {
  // A rank that waits longer than this for one message is taken for stalled.
  std::chrono::nanoseconds timeout = std::chrono::nanoseconds::max();
};

// Runs body(communicator) once for each of `ranks` ranks, each on a thread of its own and inside a
// parallel::Arena of `threads_per_rank` threads, and returns when all have. A message hands over
// its buffer without copying; one that nobody receives is dropped at the end.
//
// The first rank that throws or calls abort ends the run: all others are unwound by RunEnded as
// soon as they send or wait, and RankFailure names it. FileError, Interrupted and a RankFailure
// that a rank threw pass through as they are. When every rank that has not returned waits for a
// message that nobody can send any more, RankFailure says who waits for what.
//
// REQUIRES: ranks >= 1, threads_per_rank >= 1.
void run_threads(int ranks, int threads_per_rank, const std::function<void(Communicator&)>& body,
                 const ThreadsOptions& options = {});

}  // namespace delray::comm
