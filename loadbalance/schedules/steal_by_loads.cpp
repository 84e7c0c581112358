// An idle rank asks all others for their loads, then some for tasks, as the rule says, and starts
// anew when those are done. Busy ranks answer after the task that they do. 2 (ranks - 1) messages
// to learn the loads, each time a rank runs dry.
//
// Degenerate: where no other rank has a task that waits the rank gives up. A single rank asks
// nobody.
#include "loadbalance/schedules/steal_by_loads.h"

#include "loadbalance/schedules/initial_tasks.h"
#include "loadbalance/schedules/steal_protocol.h"

namespace delray::loadbalance::internal {
namespace {

using Kind = StealMessage::Kind;

class Thief {
 public:
  Thief(comm::Communicator& communicator, const TaskGrid& tasks, const ScheduleOptions& options,
        TaskFunction work, const StealingRule& rule)
      : communicator_(communicator),
        rule_(rule),
        runner_(communicator, options, work),
        protocol_(communicator, runner_, tasks.count()),
        loads_(static_cast<std::size_t>(communicator.size())) {
    runner_.put(initial_tasks(communicator, tasks, options));
  }

  RankReport run() {
    while (!protocol_.is_over()) {
      serve();
      if (runner_.run_one()) continue;
      if (answers_to_come_ == 0) {
        if (others_may_have_tasks_ && communicator_.size() > 1) {
          ask_for_loads();
        } else {
          protocol_.hand_up_units();
        }
      }
      if (!protocol_.is_over()) protocol_.wait();
    }
    return protocol_.finish();
  }

 private:
  // Replies to messages that have come, up to the first with tasks, some of which are begun before
  // another rank can take them.
  void serve() {
    bool any = false, has_tasks = false;
    while (!has_tasks) {
      const auto message = protocol_.next();
      if (!message) break;
      any = true;
      has_tasks = handle(*message);
    }
    if (any) runner_.served();
  }

  // Replies to a message. Returns whether it brought tasks.
  bool handle(const StealMessage& message) {
    switch (message.kind) {
      case Kind::request_load:
        protocol_.send(message.from, Kind::load, runner_.waiting());
        break;
      case Kind::request_tasks:
        protocol_.send(message.from, Kind::tasks, 1,
                       runner_.release(rule_.released(runner_.waiting(), message.value)));
        break;
      case Kind::load:
        loads_[message.from] = message.value;
        if (--answers_to_come_ == 0) ask_for_tasks();
        break;
      case Kind::tasks:
        runner_.put(message.tasks);
        if (--answers_to_come_ == 0) others_may_have_tasks_ = true;
        return !message.tasks.empty();
      default:
        break;
    }
    return false;
  }

  void ask_for_loads() {
    others_may_have_tasks_ = false;
    for (int rank = 0; rank < communicator_.size(); ++rank) {
      if (rank == communicator_.rank()) continue;
      protocol_.send(rank, Kind::request_load, 0);
      ++answers_to_come_;
    }
  }

  void ask_for_tasks() {
    for (const StealRequest& request : rule_.requests(loads_)) {
      protocol_.send(request.rank, Kind::request_tasks, request.amount);
      ++answers_to_come_;
    }
  }

  comm::Communicator& communicator_;
  const StealingRule& rule_;
  TaskRunner runner_;
  StealProtocol protocol_;
  std::vector<std::uint64_t> loads_;  // by rank, as last told; its own 0
  int answers_to_come_ = 0;
  bool others_may_have_tasks_ = true;  // false from asking for loads until tasks have come
};

}  // namespace

RankReport steal_by_loads(comm::Communicator& communicator, const TaskGrid& tasks,
                          const ScheduleOptions& options, TaskFunction work,
                          const StealingRule& rule) {
  return Thief(communicator, tasks, options, work, rule).run();
}

}  // namespace delray::loadbalance::internal
