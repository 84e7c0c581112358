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

class NeighbourThief {
 public:
  NeighbourThief(comm::Communicator& communicator, const TaskGrid& tasks,
                 const ScheduleOptions& options, TaskFunction work)
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
      if (answers_to_come_ == 0) protocol_.hand_up_units();
      if (!protocol_.is_over()) protocol_.wait();
    }
    return protocol_.finish();
  }

 private:
  enum class Asked { not_yet, with_few_left, with_none_left };
  // A neighbour in the hypercube.
  struct Peer {
    int rank = 0;
    bool unserved = false;   // it asked and got nothing
    std::uint64_t load = 0;  // as it said when it asked
  };

  // Replies to messages that have come, up to the first with tasks, some of which are begun before
  // another rank can take them.
  void serve() {
    bool any = false, has_tasks = false;
    while (!has_tasks) {
      const auto message = protocol_.next();
      if (!message) break;
      any = true;
      if (message->kind == Kind::request_tasks) {
        answer(peer(message->from), message->value);
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

  // Releases half of the difference of loads; a peer that has nothing gets the larger half.
  void answer(Peer& to, std::uint64_t load) {
    const std::uint64_t mine = runner_.waiting();
    const std::uint64_t more = mine > load ? mine - load : 0;
    const auto tasks = runner_.release(load == 0 ? (more + 1) / 2 : more / 2);
    to.unserved = tasks.empty();
    to.load = load;
    protocol_.send(to.rank, Kind::tasks, 1, tasks);
  }

  // Releases tasks that have just come to peers that got nothing before; at least one stays here.
  void share_out() {
    for (Peer& to : neighbours_) {
      if (!to.unserved) continue;
      const std::uint64_t mine = runner_.waiting();
      if (mine < to.load + 2) continue;
      const auto tasks = runner_.release((mine - to.load) / 2);
      if (tasks.empty()) continue;
      to.unserved = false;
      protocol_.send(to.rank, Kind::tasks, 0, tasks);
    }
  }

  // Asks all neighbours, once when few tasks are left and once when none are.
  void ask() {
    const std::uint64_t waiting = runner_.waiting();
    if (answers_to_come_ > 0 || waiting > ahead_) return;
    const Asked now = waiting > 0 ? Asked::with_few_left : Asked::with_none_left;
    if (asked_ >= now) return;
    asked_ = now;
    for (const Peer& to : neighbours_) {
      protocol_.send(to.rank, Kind::request_tasks, waiting);
      ++answers_to_come_;
    }
  }

  Peer& peer(int rank) {
    return *std::find_if(neighbours_.begin(), neighbours_.end(),
                         [rank](const Peer& candidate) { return candidate.rank == rank; });
  }

  TaskRunner runner_;
  StealProtocol protocol_;
  std::uint64_t ahead_;
  std::vector<Peer> neighbours_;
  Asked asked_ = Asked::not_yet;  // since tasks came last
  int answers_to_come_ = 0;
};

}  // namespace

RankReport neighbour_stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                              const ScheduleOptions& options, TaskFunction work) {
  return NeighbourThief(communicator, tasks, options, work).run();
}

}  // namespace delray::loadbalance::internal
