// State and waiting that the communicators which come from one MPI communicator share.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "comm/mpi.h"
#include "comm/mpi/mpi_header.h"
#include "comm/mpi/shared_memory.h"

namespace delray::comm::internal {

using Clock = std::chrono::steady_clock;

// A message that MPI may still be reading or writing.
struct Transfer {
  Buffer buffer;
  std::vector<MPI_Request> requests;
};

// Whether MPI has completed all requests, which empties the vector.
bool completed(std::vector<MPI_Request>& requests);

class Port;

// The state that communicators that come from one MPI communicator share.
struct Engine {
  MpiOptions options;
  MPI_Comm root = MPI_COMM_NULL;
  MPI_Comm for_splits = MPI_COMM_NULL;  // as root; nobody receives there what MPI sends to split
  int root_rank = 0;
  bool cores_are_scarce = false;  // for the ranks of this machine
  // Until when other programs are taken to want this process's core, and how often this thread had
  // lost the core when that was noticed last.
  Clock::time_point crowded_until{};
  std::int64_t switches = 0;
  Clock::time_point start = Clock::now();
  Phase phase = Phase::other;
  // Messages that MPI has not completed: sends, and receives of what nobody waited for to the end.
  // In the order of the calls.
  std::deque<Transfer> unfinished;
  std::size_t next_sweep = 64;
  std::size_t kept_by_others = 0;  // blocks in shared memory that finish_sends waited for in vain
  // MPI communicators, `root` first, the others in the order in which they were made; all live to
  // the end.
  std::vector<std::shared_ptr<Port>> ports;
  // By rank in `root`: the node-local ranks, processes of this machine that share memory.
  std::unordered_map<int, SharedMemory> local_ranks;
  bool all_are_local = false;

  void finish_some();
  // Lets go of the buffers of finished sends. O(1) per message in total.
  void reap();

  // Ends all ranks.
  [[noreturn]] void end(const std::string& why) const;
  // Ends all ranks and names the rank that does not wait itself, where this machine's memory tells:
  // of those that a chain of waiting ranks leads to, or the first that waits for nobody where any
  // would do. `waits_for` is a rank of `root` or kAnyRank.
  [[noreturn]] void end_stalled(const std::string& why, int waits_for) const;
};

// Finds out how many processes share this machine, and shares memory with them. Collective over
// `root`.
void look_at_this_machine(Engine& engine);

// Shows the node-local ranks whom this process waits for, from its construction to its destruction.
class PublishedWait {
 public:
  // `rank` is one of the root communicator, or kAnyRank.
  PublishedWait(const Engine& engine, int rank) : publishes_(!engine.local_ranks.empty()) {
    if (publishes_) publish_waiting(rank);
  }
  ~PublishedWait() {
    if (publishes_) publish_waiting(kWaitsForNobody);
  }
  PublishedWait(const PublishedWait&) = delete;
  PublishedWait& operator=(const PublishedWait&) = delete;

 private:
  bool publishes_;
};

// Waits between two calls that poll MPI: at first not at all, so that an answer is taken at once;
// then it yields the core; at last it sleeps, so that ranks without a core of their own do not take
// turns at polling. It yields longer while messages are on their way, since large ones move only
// while both ends poll. A rank that does not get its core back soon after a yield sleeps earlier
// for some time: others have work for the core, and the system prefers threads that were woken to
// those that never slept.
class Backoff {
 public:
  explicit Backoff(Engine& engine)
      : engine_(engine),
        last_look_(Clock::now()),
        is_crowded_(last_look_ < engine.crowded_until),
        looks_(engine.cores_are_scarce ? kSpins
               : is_crowded_           ? kSpins - kFewSpins
                                       : 0) {}

  // How often others have rung for this process. To be read before polling, and given to pause().
  std::uint32_t rings() const { return engine_.local_ranks.empty() ? 0 : internal::rings(); }

  void pause(bool on_their_way = false, std::optional<std::uint32_t> rings_seen = std::nullopt);

 private:
  using Microseconds = std::chrono::microseconds;

  void notice_others();

  // Polling and yielding once takes about a microsecond where nobody else wants the core.
  static constexpr int kSpins = 1000, kYields = 1000, kYieldsOnTheWay = 100000;
  // Spins on a crowded machine: the rank that is to answer may have a core at the moment.
  static constexpr int kFewSpins = 300;
  // Where senders ring: always, or unless they are on other machines. MPI may deliver only after
  // the bell, or the sender have none for this process, so polling goes on at longer and longer
  // intervals.
  static constexpr int kYieldsBeforeSleep = 4;
  static constexpr Microseconds kLongestSleep{8000}, kShortSleep{50};
  // MPI_Improbe takes in what has come after it has looked, and finds it when it is called again.
  static constexpr int kLooksAfterSleep = 4;
  // Where no sender rings.
  static constexpr Microseconds kShortestSleep{20}, kLongShortSleep{200};

  Engine& engine_;
  Clock::time_point last_look_;
  bool is_crowded_;
  int looks_;
  int looks_after_sleep_ = 0;
  Microseconds long_sleep_{1000}, short_sleep_ = kShortestSleep;
};

// A limit to how long a rank waits. Reads no clock where the limit is max().
class Wait {
 public:
  explicit Wait(std::chrono::nanoseconds limit) : limit_(limit) {
    if (limited()) begin_ = Clock::now();
  }
  bool is_over() const { return limited() && Clock::now() - begin_ >= limit_; }
  std::string text() const;  // the limit: "2.5 s"

 private:
  bool limited() const { return limit_ != std::chrono::nanoseconds::max(); }
  std::chrono::nanoseconds limit_;
  Clock::time_point begin_{};
};

}  // namespace delray::comm::internal
