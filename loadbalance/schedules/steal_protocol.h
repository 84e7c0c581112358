// The messages of ranks that steal tasks from each other, and how the ranks find out that all tasks
// are begun.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "loadbalance/schedules/task_runner.h"

namespace delray::loadbalance::internal {

struct StealMessage {
  enum class Kind : std::uint64_t {
    request_load,   // the reply is load
    load,           // value: the sender's tasks that wait
    request_tasks,  // value: how many (stealing.cpp) or the sender's load (neighbour_stealing.cpp);
                    // the reply is tasks
    tasks,          // value: 1 for a reply, 0 for tasks that nobody asked for any more
    begun,          // value: units that the sender hands up
    over,           // all tasks are begun
  };
  int from = 0;
  Kind kind = Kind::over;
  std::uint64_t value = 0;
  std::vector<TaskRange> tasks;
};

// One rank's messages and its part in counting. Every rank has one unit to begin with, and gets one
// for each task that it begins; when it is quiet, with no tasks that wait and no reply to come, it
// hands its units up a binomial tree of ranks. When all have come to rank 0 all tasks are begun,
// and no message is under way as long as a rank only asks when it holds a unit.
class StealProtocol {
 public:
  // REQUIRES: `runner` outlives it; `tasks` is the number of tasks of all ranks.
  StealProtocol(comm::Communicator& communicator, TaskRunner& runner, std::uint64_t tasks);

  void send(int to, StealMessage::Kind kind, std::uint64_t value,
            std::span<const TaskRange> tasks = {});
  // The next message of the schedule's own, if one is there; handles those of the count.
  std::optional<StealMessage> next();
  // Waits for any message.
  void wait();

  // Whether this rank has begun a task, or anything at all, since it was quiet.
  bool holds_unit() const { return units_ > 0 || runner_.begun() > counted_; }
  // Tells the count that this rank is quiet. REQUIRES: no task waits and no reply is to come.
  void hand_up_units();
  bool is_over() const { return over_; }
  // Waits for all ranks, since one that has left must not ask another that has not, and ends the
  // run. The last call. REQUIRES: it is over.
  RankReport finish();

 private:
  void end();

  comm::Communicator& communicator_;
  TaskRunner& runner_;
  std::uint64_t total_;
  std::uint64_t units_ = 1;    // own and from below, to be handed up; rank 0: all that have come
  std::uint64_t counted_ = 0;  // tasks that this rank has begun and that are in the units
  bool over_ = false;
};

}  // namespace delray::loadbalance::internal
