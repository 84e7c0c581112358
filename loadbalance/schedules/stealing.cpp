// Work stealing by loads (Heirich and Arvo 1997): an idle rank learns all loads and takes as much
// as the mean from those above it.
//
// It asks each rank with more than the mean in proportion to its excess, with rounding errors
// carried on, and starts anew when those tasks are done. Busy ranks answer after the task that they
// do. 2 (ranks - 1) messages to learn the loads, each time a rank runs dry.
//
// Degenerate: where no other rank has a task that waits the rank gives up. A single rank asks
// nobody.
#include <algorithm>
#include <cmath>

#include "loadbalance/schedules/initial_tasks.h"
#include "loadbalance/schedules/schedules.h"
#include "loadbalance/schedules/steal_protocol.h"

namespace delray::loadbalance::internal {
namespace {

using Kind = StealMessage::Kind;

class Thief {
 public:
  Thief(comm::Communicator& communicator, const TaskGrid& tasks, const ScheduleOptions& options,
        TaskFunction work)
      : communicator_(communicator),
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
        protocol_.send(message.from, Kind::tasks, 1, runner_.release(message.value));
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

  // Asks ranks with more than the mean for as many tasks together as the mean, rounded up.
  void ask_for_tasks() {
    double total = 0, excess = 0;
    for (const std::uint64_t load : loads_) total += static_cast<double>(load);
    if (!(total > 0)) return;
    const double mean = total / static_cast<double>(loads_.size());
    const double wanted = std::ceil(mean);
    for (const std::uint64_t load : loads_)
      excess += std::max(0.0, static_cast<double>(load) - mean);
    // Rounding is carried on from one to the next, so that the sum is right.
    double before = 0, asked = 0;
    for (int rank = 0; rank < communicator_.size(); ++rank) {
      const double above = static_cast<double>(loads_[rank]) - mean;
      if (above <= 0) continue;
      before += above;
      const double amount =
          std::min(static_cast<double>(loads_[rank]), std::round(wanted * before / excess) - asked);
      if (amount < 1) continue;
      asked += amount;
      protocol_.send(rank, Kind::request_tasks, static_cast<std::uint64_t>(amount));
      ++answers_to_come_;
    }
  }

  comm::Communicator& communicator_;
  TaskRunner runner_;
  StealProtocol protocol_;
  std::vector<std::uint64_t> loads_;  // by rank, as last told; its own 0
  int answers_to_come_ = 0;
  bool others_may_have_tasks_ = true;  // false from asking for loads until tasks have come
};

}  // namespace

RankReport stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                    const ScheduleOptions& options, TaskFunction work) {
  return Thief(communicator, tasks, options, work).run();
}

}  // namespace delray::loadbalance::internal
