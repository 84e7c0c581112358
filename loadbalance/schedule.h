// Schedules: which rank does which task, and when.
//
// Ranks learn of tasks by messages; the threads of a rank pull theirs from what the rank has. A
// rank handles messages between two tasks of its first thread, so tasks should be short beside the
// whole run: some 10 us to 10 ms.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "comm/communicator.h"
#include "loadbalance/task_grid.h"
#include "parallel/function_ref.h"

namespace delray::loadbalance {

class DivisibleWork;

// Options of a schedule.
struct ScheduleOptions {
  // Threads of this rank; 0: as many as its arena has. One on the simulated machine.
  int threads = 0;
  // Whether ranks that hand out tasks do some themselves, between messages. One that is alone does.
  bool master_works = true;
  // demand, guided, hierarchical: tasks handed out to a rank at once; 0: one for each of the
  // master's threads.
  std::uint32_t batch = 0;
  // A rank asks for more when no more than this many tasks wait: by default when none do, with
  // neighbour-stealing two for each thread.
  std::optional<std::uint32_t> ahead;
  // guided: part of the rest, divided by the number of ranks, that is handed out at once, but no
  // fewer than `batch`. 1 as in guided self-scheduling (Polychronopoulos and Kuck 1987); less
  // leaves more for evening out.
  double share = 0.25;
  int fan_out = 4;         // hierarchical: ranks below a master, at most; >= 2
  std::uint64_t seed = 1;  // random
  // The tasks that this rank begins with, with static and all kinds of stealing; each task is in
  // the list of exactly one rank. By default as many consecutive tasks for each.
  std::optional<std::vector<TaskRange>> initial;
  // Of schedules that divide tasks: the units of tasks, this rank's. The task function only begins
  // a task then, on thread 0, and its units wait in here. Null: tasks stay whole.
  DivisibleWork* divisible = nullptr;
};

// A thread of a rank from `begin` to `end`: doing `tasks` tasks one after the other, handling
// messages, or waiting for a message or for tasks.
struct Interval {
  enum class Kind : std::uint32_t { work, serve, wait } kind = Kind::work;
  std::uint32_t thread = 0;
  std::uint64_t tasks = 0;
  double begin = 0, end = 0;  // Communicator::seconds
};

// The work of one rank, counted; times measured.
struct ScheduleCounts {
  std::int32_t rank = 0, threads = 0;
  std::uint64_t tasks = 0;
  std::uint64_t requests = 0;      // messages that ask for tasks or for a load, sent
  std::uint64_t steals = 0;        // messages with tasks of another rank's share, received
  std::uint64_t tasks_stolen = 0;  // in those
  std::uint64_t units_stolen = 0;  // in those, of tasks that were begun elsewhere
  std::uint64_t messages = 0, bytes_sent = 0;  // of the schedule, sent to other ranks
  double begin = 0, end = 0;                   // Communicator::seconds at the call and the return
  double busy = 0, idle = 0;                   // seconds at tasks and waiting, summed over threads
};

// The work of a rank under a schedule: counts, and the times of its threads.
struct RankReport : ScheduleCounts {
  std::vector<Interval> timeline;  // by thread, then time
};

// Does a task; called once for each task, on one rank, at the same time for several tasks where
// there are several threads: 0 (the caller of run) to threads - 1. Must not communicate, but thread
// 0 may call Communicator::work. Loops over parallel/ inside of it do not use the rank's arena.
using TaskFunction = parallel::FunctionRef<void(std::uint32_t task, int thread)>;

// An entry of the table of schedules.
struct Schedule {
  const char* name;
  const char* description;
  // Collective: returns when this rank has done its tasks and will get no more: with stealing when
  // all have been begun, divisible ones done, with the other schedules maybe earlier. What a task
  // throws, run throws, once this rank's other threads are done with theirs; as any exception it
  // ends the run of all ranks. Leaves no message behind.
  //
  // Throws std::invalid_argument for options that cannot be, and tasks of `initial` that there are
  // not. REQUIRES: the same grid and options on all ranks, but for threads and initial.
  RankReport (*run)(comm::Communicator& communicator, const TaskGrid& tasks,
                    const ScheduleOptions& options, TaskFunction work);
  const char* group;        // of schedules that work alike; reports show these in one colour
  bool has_master = false;  // some ranks hand out tasks: ScheduleOptions::master_works
  bool begins_with_shares = false;  // ScheduleOptions::initial
  bool divides = false;             // ScheduleOptions::divisible
};

// The table: --list, tests, benchmarks and reports iterate over it.
std::span<const Schedule> schedules();
const Schedule* find_schedule(std::string_view name);  // nullptr when there is none

// Collective: every rank's report on rank 0, by rank; nothing elsewhere.
std::vector<RankReport> gather_reports(comm::Communicator& communicator, const RankReport& mine);

}  // namespace delray::loadbalance
