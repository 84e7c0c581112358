// Ranks that are threads of this process.
#pragma once

#include <chrono>
#include <functional>

#include "comm/communicator.h"
#include "comm/failure.h"

namespace delray::comm {

// When ranks of one process are taken for stalled.
struct ThreadsOptions {
  // A rank that waits longer than this for one message is taken for stalled.
  std::chrono::nanoseconds timeout = std::chrono::nanoseconds::max();
  // Called, if not empty, where a rank was taken for stalled and ranks still run two seconds later:
  // they neither send nor wait, and run_threads waits for them. May end the process.
  std::function<void(const RankFailure&)> on_stuck = {};
};

// Runs body(communicator) once for each of `ranks` ranks, each on a thread of its own and inside a
// parallel::Arena of `threads_per_rank` threads, and returns when all have. A message hands over
// its buffer without copying; one that nobody receives is dropped at the end.
//
// The first rank that throws or calls abort ends the run: all others are unwound by RunEnded as
// soon as they send or wait, and RankFailure names it. FileError, Interrupted,
// std::invalid_argument and a RankFailure that a rank threw pass through as they are,
// std::bad_alloc as OutOfMemory. When every rank that has not returned waits for a message that
// nobody can send any more, RankFailure says who waits for what; where one waits too long, it names
// the rank that the wait is for in the end. Throws std::invalid_argument unless 1 <= ranks, 1 <=
// threads_per_rank <= kMostThreadsPerRank.
inline constexpr int kMostThreadsPerRank = 4096;
void run_threads(int ranks, int threads_per_rank, const std::function<void(Communicator&)>& body,
                 const ThreadsOptions& options = {});

}  // namespace delray::comm
