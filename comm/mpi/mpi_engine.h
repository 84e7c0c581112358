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

// Whether all are; then there are none any more.
bool completed(std::vector<MPI_Request>& requests);

class Port;

// The state that communicators that come from one MPI communicator share.
struct Engine {
  MpiOptions options;
  MPI_Comm root = MPI_COMM_NULL;
  MPI_Comm for_splits = MPI_COMM_NULL;  // as root; nobody receives there what MPI sends to split
  int root_rank = 0;
  bool cores_are_scarce = false;      // for the ranks of this machine
  Clock::time_point crowded_until{};  // by whatever else runs on it, as far as was noticed
  std::int64_t switches = 0;          // how often this thread had lost its core by then
  Clock::time_point start = Clock::now();
  Phase phase = Phase::other;
  // Messages that were sent, and those that came but were never received. Front to back in the
  // order of the calls.
  std::deque<Transfer> unfinished;
  std::size_t next_sweep = 64;
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

// Tells the node-local ranks whom this process waits for, as long as it lives.
class TellWaiting {
 public:
  // `rank` is one of the root communicator, or kAnyRank.
  TellWaiting(const Engine& engine, int rank) : tells_(!engine.local_ranks.empty()) {
    if (tells_) tell_waiting(rank);
  }
  ~TellWaiting() {
    if (tells_) tell_waiting(kWaitsForNobody);
  }
  TellWaiting(const TellWaiting&) = delete;
  TellWaiting& operator=(const TellWaiting&) = delete;

 private:
  bool tells_;
};

// Waits between two looks at MPI: at first not at all, so that an answer is taken at once; then it
// lets others run; at last it sleeps, so that ranks without a core of their own do not take turns
// at finding nothing. While messages are on their way, which large ones are only as long as both
// ends look, it takes long to sleep. A rank that does not get its core back soon sleeps earlier for
// some time: others have work for the core, and whoever was woken comes before those who never
// slept.
class Backoff {
 public:
  explicit Backoff(Engine& engine)
      : engine_(engine),
        last_look_(Clock::now()),
        is_crowded_(last_look_ < engine.crowded_until),
        looks_(engine.cores_are_scarce ? kSpins
               : is_crowded_           ? kSpins - kFewSpins
                                       : 0) {}

  // How often others have rung for this process. To be read before one looks.
  std::uint32_t rings() const { return engine_.local_ranks.empty() ? 0 : internal::rings(); }

  void pause(bool on_their_way = false, std::optional<std::uint32_t> rings_seen = std::nullopt);

 private:
  using Microseconds = std::chrono::microseconds;

  void notice_others();

  // A look and a yield take about a microsecond where nobody else wants the core.
  static constexpr int kSpins = 1000, kYields = 1000, kYieldsOnTheWay = 100000;
  // Whoever is to answer may just have a core.
  static constexpr int kFewSpins = 300;
  // Where those who send ring: for all messages, or but for those from other machines. Should MPI
  // deliver only after the bell, or the sender have no bell for it, looks go on at longer and
  // longer intervals.
  static constexpr int kYieldsBeforeSleep = 4;
  static constexpr Microseconds kLongestSleep{8000}, kShortSleep{50};
  // Where nobody rings.
  static constexpr Microseconds kShortestSleep{20}, kLongShortSleep{200};

  Engine& engine_;
  Clock::time_point last_look_;
  bool is_crowded_;
  int looks_;
  Microseconds long_sleep_{1000}, short_sleep_ = kShortestSleep;
};

// How long a rank has waited, against how long it may. Takes no time where the limit is max().
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
