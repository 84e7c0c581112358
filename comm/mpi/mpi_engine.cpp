// How ranks that are MPI processes wait: without taking the core from those that they wait for, and
// not forever.
#include "comm/mpi/mpi_engine.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <thread>

#include "comm/exit_code.h"
#include "comm/mpi/mpi_end.h"

namespace delray::comm::internal {
namespace {

// What a rank of this node is doing; nothing for a rank of another node.
std::optional<Doing> doing_of(const Engine& engine, int rank) {
  const auto local_rank = engine.local_ranks.find(rank);
  if (local_rank == engine.local_ranks.end()) return std::nullopt;
  return doing(local_rank->second);
}

// Shares memory with the processes of this machine, `local`, if each of them wants to, has some and
// can reach that of the next: all agree.
void share_with_local_ranks(Engine& engine, MPI_Comm local, int processes) {
  struct LocalRank {
    std::int64_t rank;
    SharedMemory memory;
  };
  const LocalRank mine{engine.root_rank,
                       engine.options.share_memory ? share_memory() : SharedMemory{}};
  std::vector<LocalRank> local_ranks(static_cast<std::size_t>(processes));
  MPI_Allgather(&mine, sizeof mine, MPI_BYTE, local_ranks.data(), sizeof mine, MPI_BYTE, local);
  int rank = 0;
  MPI_Comm_rank(local, &rank);
  const LocalRank& next = local_ranks[static_cast<std::size_t>((rank + 1) % processes)];
  int reached = engine.options.share_memory && can_reach(next.memory);
  MPI_Allreduce(MPI_IN_PLACE, &reached, 1, MPI_INT, MPI_MIN, local);
  if (!reached) return;
  for (const LocalRank& local_rank : local_ranks) {
    if (local_rank.rank != engine.root_rank) {
      engine.local_ranks.emplace(static_cast<int>(local_rank.rank), local_rank.memory);
    }
  }
  int all = 1;
  MPI_Comm_size(engine.root, &all);
  engine.all_are_local = processes == all;
}

// How often the system has given this thread's core to another.
std::int64_t lost_cores() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nivcsw;
}

}  // namespace

bool completed(std::vector<MPI_Request>& requests) {
  if (requests.empty()) return true;
  int done = 0;
  MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
  if (done) requests.clear();
  return done != 0;
}

void Engine::finish_some() {
  std::erase_if(unfinished, [](Transfer& transfer) { return completed(transfer.requests); });
}

void Engine::reap() {
  while (!unfinished.empty() && completed(unfinished.front().requests)) unfinished.pop_front();
  // One slow receiver must not keep the buffers for all others alive.
  if (unfinished.size() < next_sweep) return;
  finish_some();
  next_sweep = std::max<std::size_t>(64, 2 * unfinished.size());
}

void Engine::end(const std::string& why) const {
  end_all_ranks(root, root_rank, phase, why, kRankLost);
}

void Engine::end_stalled(const std::string& why, int waits_for) const {
  int rank = waits_for;
  if (rank == kAnyRank) {
    for (const auto& [other, unused] : local_ranks) {
      const auto what = doing_of(*this, other);
      if (!what || what->waits_for != kWaitsForNobody) continue;
      rank = rank == kAnyRank ? other : std::min(rank, other);
    }
  }
  for (std::size_t steps = 0; steps <= local_ranks.size() && rank >= 0; ++steps) {
    const auto what = doing_of(*this, rank);
    if (!what) break;
    if (what->waits_for == kWaitsForNobody) {
      end_all_ranks(root, rank, what->phase, why, kRankLost);
    }
    rank = what->waits_for;
  }
  end(why);
}

void look_at_this_machine(Engine& engine) {
  MPI_Comm local = MPI_COMM_NULL;
  MPI_Comm_split_type(engine.root, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &local);
  int processes = 1;
  MPI_Comm_size(local, &processes);
  engine.cores_are_scarce = processes > sysconf(_SC_NPROCESSORS_ONLN);  // bound to some or not
  engine.switches = lost_cores();
  if (processes > 1) share_with_local_ranks(engine, local, processes);
  MPI_Comm_free(&local);
}

void Backoff::pause(bool on_their_way, std::optional<std::uint32_t> rings_seen) {
  if (looks_after_sleep_ > 0) {
    --looks_after_sleep_;
    return;
  }
  ++looks_;
  if (looks_ <= kSpins) {
    constexpr int kLooksBetween = 64;
    if (looks_ % kLooksBetween == 0) notice_others();
    return;
  }
  const bool can_be_woken = rings_seen && !on_their_way && !engine_.local_ranks.empty();
  const int yields = can_be_woken ? kYieldsBeforeSleep : on_their_way ? kYieldsOnTheWay : kYields;
  if (!is_crowded_ && looks_ <= kSpins + yields) {
    sched_yield();
    notice_others();
  } else if (can_be_woken) {
    sleep_until_rung(*rings_seen, engine_.all_are_local ? long_sleep_ : kShortSleep);
    long_sleep_ = std::min(2 * long_sleep_, kLongestSleep);
    looks_after_sleep_ = kLooksAfterSleep;
  } else {
    std::this_thread::sleep_for(short_sleep_);
    short_sleep_ = std::min(short_sleep_ + kShortestSleep, kLongShortSleep);
  }
}

void Backoff::notice_others() {
  constexpr std::chrono::milliseconds kSlice{1};  // few looks take as long
  constexpr std::chrono::milliseconds kRemembered{100};
  const Clock::time_point now = Clock::now();
  if (now - last_look_ > kSlice) {
    const std::int64_t switches = lost_cores();
    if (switches != engine_.switches) {
      engine_.crowded_until = now + kRemembered;
      is_crowded_ = true;
      looks_ = std::max(looks_, kSpins);
    }
    engine_.switches = switches;
  }
  last_look_ = now;
}

std::string Wait::text() const {
  std::array<char, 32> seconds{};
  std::snprintf(seconds.data(), seconds.size(), "%.3g s",
                std::chrono::duration<double>(limit_).count());
  return seconds.data();
}

}  // namespace delray::comm::internal
