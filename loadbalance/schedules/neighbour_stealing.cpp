// Work stealing between neighbours in a hypercube (Heirich and Arvo 1997), with lifelines (Saraswat
// et al. 2011).
//
// A rank asks its neighbours once when few tasks are left and once more when none are. A rank that
// is asked releases half of the difference of loads; if it has nothing to release it remembers who
// asked and shares tasks that arrive later. 2 log(ranks) messages each time a rank asks.
// StealProtocol finds the end.
//
// Degenerate: a number of ranks that is no power of two leaves some ranks with fewer neighbours; a
// single rank has none.
#include <algorithm>

#include "loadbalance/schedules/initial_tasks.h"
#include "loadbalance/schedules/schedules.h"
#include "loadbalance/schedules/steal_protocol.h"

namespace delray::loadbalance::internal {
namespace {

using Kind = StealMessage::Kind;

class Neighbour {
 public:
  Neighbour(comm::Communicator& communicator, const TaskGrid& tasks, const ScheduleOptions& options,
            TaskFunction work)
      : runner_(communicator, options, work),
        protocol_(communicator, runner_, tasks.count()),
        ahead_(options.ahead.value_or(2 * static_cast<std::uint32_t>(runner_.threads()))) {
    for (int bit = 1; bit < communicator.size(); bit *= 2) {
      const int neighbour = communicator.rank() ^ bit;
      if (neighbour < communicator.size()) neighbours_.push_back({neighbour, false, 0});
    }
    runner_.put(initial_tasks(communicator, tasks, options));
  }

  RankReport run() {
    while (!protocol_.is_over()) {
      serve();
      const bool worked = runner_.run_one();
      ask();
      if (worked) continue;
      if (answers_to_come_ == 0) protocol_.quiet();
      if (!protocol_.is_over()) protocol_.wait();
    }
    return protocol_.finish();
  }

 private:
  enum class Asked { not_yet, with_few_left, with_none_left };
  struct Other {
    int rank = 0;
    bool unserved = false;  // it asked and got nothing
    std::uint64_t load = 0;
  };

  // Replies to messages that have come, up to tasks: of those some are begun before anybody can
  // take them.
  void serve() {
    bool any = false, has_tasks = false;
    while (!has_tasks) {
      const auto message = protocol_.next();
      if (!message) break;
      any = true;
      if (message->kind == Kind::ask_tasks) {
        answer(other(message->from), message->value);
      } else if (message->kind == Kind::tasks) {
        if (message->value == 1) --answers_to_come_;
        if (message->tasks.empty()) continue;
        runner_.put(message->tasks);
        asked_ = Asked::not_yet;
        share_out();
        has_tasks = true;
      }
    }
    if (any) runner_.served();
  }

  // Half of what there is more here than there; one who has nothing gets the larger half.
  void answer(Other& to, std::uint64_t load) {
    const std::uint64_t mine = runner_.waiting();
    const std::uint64_t more = mine > load ? mine - load : 0;
    const auto tasks = runner_.release(load == 0 ? (more + 1) / 2 : more / 2);
    to.unserved = tasks.empty();
    to.load = load;
    protocol_.send(to.rank, Kind::tasks, 1, tasks);
  }

  // Releases of what has just come to those who got nothing before; at least one task stays here.
  void share_out() {
    for (Other& to : neighbours_) {
      if (!to.unserved) continue;
      const std::uint64_t mine = runner_.waiting();
      if (mine < to.load + 2) continue;
      const auto tasks = runner_.release((mine - to.load) / 2);
      if (tasks.empty()) continue;
      to.unserved = false;
      protocol_.send(to.rank, Kind::tasks, 0, tasks);
    }
  }

  // All neighbours, once when few tasks are left and once when none are.
  void ask() {
    const std::uint64_t waiting = runner_.waiting();
    if (answers_to_come_ > 0 || waiting > ahead_) return;
    const Asked now = waiting > 0 ? Asked::with_few_left : Asked::with_none_left;
    if (asked_ >= now) return;
    asked_ = now;
    for (const Other& to : neighbours_) {
      protocol_.send(to.rank, Kind::ask_tasks, waiting);
      ++answers_to_come_;
    }
  }

  Other& other(int rank) {
    return *std::find_if(neighbours_.begin(), neighbours_.end(),
                         [rank](const Other& candidate) { return candidate.rank == rank; });
  }

  TaskRunner runner_;
  StealProtocol protocol_;
  std::uint64_t ahead_;
  std::vector<Other> neighbours_;
  Asked asked_ = Asked::not_yet;  // since tasks came last
  int answers_to_come_ = 0;
};

}  // namespace

RankReport neighbour_stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                              const ScheduleOptions& options, TaskFunction work) {
  return Neighbour(communicator, tasks, options, work).run();
}

}  // namespace delray::loadbalance::internal
