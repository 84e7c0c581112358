// Ranks work at units of their tasks, a short time at once, and answer messages in between. A rank
// that has none left, or few, asks others, which release tasks that they have not begun and units
// of those that they have; what is found of these goes back to the task's own rank. A rank that had
// nothing to release remembers who asked, and shares what its units turn into later (lifelines:
// Saraswat et al. 2011). The end is found by four counters (comm/termination.h).
//
// Degenerate: so few units that they are not worth a message stay where they are. A single rank
// asks nobody.
#include "loadbalance/schedules/unit_stealing.h"

#include <algorithm>
#include <cstring>
#include <deque>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "comm/bad_message.h"
#include "comm/collectives.h"
#include "comm/forwarding.h"
#include "comm/termination.h"
#include "loadbalance/divisible_work.h"
#include "loadbalance/schedules/initial_tasks.h"
#include "loadbalance/schedules/steal_by_loads.h"
#include "loadbalance/schedules/tags.h"
#include "loadbalance/schedules/task_runner.h"

namespace delray::loadbalance::internal {
namespace {

// Units that are worth a message: some hundred microseconds of rays, where one takes some ten.
constexpr std::uint64_t kLeastUnits = 128;
// Units left at which a rank asks its neighbours.
constexpr std::uint64_t kFewUnits = 512;

struct UnitHeader {
  enum class Kind : std::uint64_t {
    request_load,   // the reply is load
    load,           // value: the sender's units that wait
    request_units,  // value: how many, or the sender's load where neighbours are asked; the reply
                    // is units
    units,          // value: 1 for a reply, 0 for what nobody asked for any more; tasks, then units
    results,        // of units of the receiver's tasks
    control,        // of Termination
  } kind;
  std::uint64_t value = 0, tasks = 0;  // tasks: number of ranges
};

// Messages of Termination among the others: whoever waits waits for both.
class ControlChannel final : public comm::ForwardingCommunicator {
 public:
  ControlChannel(comm::Communicator& inner, TaskRunner& runner)
      : ForwardingCommunicator(inner), runner_(runner) {}

  void send(int to, comm::Tag, comm::Buffer&& message) override {
    const UnitHeader header{UnitHeader::Kind::control};
    comm::Buffer whole(sizeof(header) + message.size());
    std::memcpy(whole.data(), &header, sizeof(header));
    std::memcpy(whole.data() + sizeof(header), message.data(), message.size());
    runner_.send(to, kTagSteal, std::move(whole));
  }
  comm::Buffer receive(int, comm::Tag) override { return std::move(received); }

  comm::Buffer received;  // what handle() is about

 private:
  TaskRunner& runner_;
};

ScheduleOptions one_thread(ScheduleOptions options) {
  options.threads = 1;
  return options;
}

class UnitThief {
 public:
  UnitThief(comm::Communicator& communicator, const TaskGrid& tasks, const ScheduleOptions& options,
            TaskFunction work, Asked asked)
      : communicator_(communicator),
        work_(*options.divisible),
        asked_(asked),
        begin_(work),
        runner_(communicator, one_thread(options), begin_task_),
        control_(communicator, runner_),
        termination_(control_, kTagSteal),
        loads_(static_cast<std::size_t>(communicator.size())),
        is_unserved_(loads_.size()) {
    const int rank = communicator.rank();
    for (int other = 0; other < communicator.size(); ++other) {
      const int difference = rank ^ other;
      const bool is_neighbour = (difference & (difference - 1)) == 0;
      if (other != rank && (asked == Asked::all_by_load || is_neighbour)) others_.push_back(other);
    }
    if (!others_.empty()) next_ = Next::ask_others;
    put(initial_tasks(communicator, tasks, options));
  }

  RankReport run() {
    while (!termination_.is_over()) {
      serve();
      while (work_.wants_task() && runner_.run_one()) {
      }
      const bool worked = work_.advance();
      if (worked) {
        runner_.worked();
        send_results();
        share_out();
      }
      if (next_ != Next::wait && answers_to_come_ == 0 && load() <= ahead()) ask();
      if (worked) continue;
      if (answers_to_come_ == 0) termination_.idle();
      if (!termination_.is_over()) runner_.wait(comm::kAnyRank, kTagSteal);
    }
    // A rank that has left must not ask another that has not.
    comm::barrier(communicator_);
    runner_.waited();
    return runner_.finish();
  }

 private:
  using Kind = UnitHeader::Kind;

  std::uint64_t load() const { return units_not_begun_ + work_.waiting(); }
  std::uint64_t ahead() const { return asked_ == Asked::neighbours ? kFewUnits : 0; }

  void put(std::span<const TaskRange> ranges) {
    for (const TaskRange& range : ranges) {
      for (std::uint32_t task = range.first; task < range.last; ++task)
        units_not_begun_ += work_.units_of(task);
    }
    runner_.put(ranges);
  }

  void send(int to, Kind kind, std::uint64_t value, std::span<const TaskRange> tasks = {},
            const comm::Buffer& units = {}) {
    const UnitHeader header{kind, value, tasks.size()};
    comm::Buffer message(sizeof(header) + tasks.size_bytes() + units.size());
    std::memcpy(message.data(), &header, sizeof(header));
    if (!tasks.empty())
      std::memcpy(message.data() + sizeof(header), tasks.data(), tasks.size_bytes());
    if (!units.empty())
      std::memcpy(message.data() + sizeof(header) + tasks.size_bytes(), units.data(), units.size());
    const std::size_t bytes = sizeof(header) + tasks.size_bytes() + units.counted_bytes();
    if (kind == Kind::request_load || kind == Kind::request_units) ++runner_.report.requests;
    termination_.count_sent();
    runner_.send(to, kTagSteal, comm::Buffer::standing_for(bytes, std::move(message)));
  }

  // Handles messages that have come, up to the first with units, some of which are done before
  // another rank can take them.
  void serve() {
    bool any = false, has_units = false;
    while (!has_units && !termination_.is_over()) {
      const auto envelope = communicator_.probe(comm::kAnyRank, kTagSteal, comm::Deadline::now());
      if (!envelope) break;
      any = true;
      has_units = handle(envelope->source, communicator_.receive(envelope->source, kTagSteal));
    }
    if (any) runner_.served();
  }

  // Returns whether the message brought tasks or units.
  bool handle(int from, const comm::Buffer& message) {
    UnitHeader header;
    comm::check_message(message.size() >= sizeof(header));
    std::memcpy(&header, message.data(), sizeof(header));
    const std::span<const std::byte> rest{message.data() + sizeof(header),
                                          message.size() - sizeof(header)};
    if (header.kind == Kind::control) {
      control_.received = comm::Buffer::of(rest);
      termination_.handle({from, kTagSteal, rest.size()});
      return false;
    }
    termination_.count_received();
    switch (header.kind) {
      case Kind::request_load:
        if (load() < kLeastUnits) remember(from);
        send(from, Kind::load, load());
        break;
      case Kind::load:
        loads_[static_cast<std::size_t>(from)] = header.value;
        if (--answers_to_come_ == 0) ask_for_units();
        break;
      case Kind::request_units:
        answer(from, header.value);
        break;
      case Kind::units:
        if (header.value == 1) --answers_to_come_;
        return take(from, header, rest);
      case Kind::results:
        work_.put_results(rest);
        break;
      case Kind::control:
        break;
    }
    return false;
  }

  bool take(int from, const UnitHeader& header, std::span<const std::byte> rest) {
    comm::check_message(header.tasks <= rest.size() / sizeof(TaskRange));
    std::vector<TaskRange> ranges(static_cast<std::size_t>(header.tasks));
    const std::size_t bytes = ranges.size() * sizeof(TaskRange);
    if (bytes > 0) std::memcpy(ranges.data(), rest.data(), bytes);
    put(ranges);
    for (const TaskRange& range : ranges) runner_.report.tasks_stolen += range.count();
    rest = rest.subspan(bytes);
    if (!rest.empty()) runner_.report.units_stolen += work_.put(rest);
    if (ranges.empty() && rest.empty()) {
      if (asked_giver_) next_ = Next::ask_others;
      return false;
    }
    ++runner_.report.steals;
    const bool asked_for = header.value == 1 && !asked_giver_;
    giver_ = from;
    next_ = asked_for || asked_ == Asked::neighbours ? Next::ask_others : Next::ask_giver;
    return true;
  }

  // Who has shared last unasked, then all others.
  void ask() {
    asked_giver_ = std::exchange(next_, Next::wait) == Next::ask_giver;
    if (asked_giver_) {
      send(giver_, Kind::request_units, std::numeric_limits<std::uint64_t>::max());
      ++answers_to_come_;
      return;
    }
    for (const int other : others_) {
      send(other, asked_ == Asked::neighbours ? Kind::request_units : Kind::request_load, load());
      ++answers_to_come_;
    }
  }

  void ask_for_units() {
    for (const StealRequest& request : kStealFromAboveMean.requests(loads_)) {
      send(request.rank, Kind::request_units, std::max(request.amount, kLeastUnits));
      ++answers_to_come_;
    }
  }

  // Neighbours get half of what this rank has more; others what they ask for, at most half.
  void answer(int from, std::uint64_t value) {
    const std::uint64_t mine = load();
    const std::uint64_t amount = asked_ == Asked::neighbours
                                     ? (mine > value ? (mine - value) / 2 : 0)
                                     : std::min(value, mine / 2);
    if (!give(from, amount, 1)) {
      send(from, Kind::units, 1);
      remember(from);
    }
  }

  void remember(int rank) {
    if (std::exchange(is_unserved_[static_cast<std::size_t>(rank)], std::uint8_t{1}) == 0)
      unserved_.push_back(rank);
  }

  // To ranks that have nothing to do and got nothing here: equal shares, one of which stays.
  void share_out() {
    while (!unserved_.empty()) {
      if (!give(unserved_.front(), load() / (unserved_.size() + 1), 0)) return;
      is_unserved_[static_cast<std::size_t>(unserved_.front())] = 0;
      unserved_.pop_front();
    }
  }

  // At most so many units: of tasks that are not begun, then of those that are. Returns whether
  // there were any that are worth it.
  bool give(int to, std::uint64_t amount, std::uint64_t is_reply) {
    if (amount < kLeastUnits) return false;
    std::vector<TaskRange> ranges;
    while (amount > 0) {
      const std::vector<TaskRange> last = runner_.release(1);
      if (last.empty()) break;
      const std::uint64_t units = work_.units_of(last.front().first);
      if (units > amount) {
        runner_.put(last);
        break;
      }
      amount -= units;
      units_not_begun_ -= units;
      ranges.push_back(last.front());
    }
    DivisibleWork::Released released;
    if (amount >= kLeastUnits) released = work_.release(amount);
    if (ranges.empty() && released.units == 0) return false;
    send(to, Kind::units, is_reply, ranges, released.message);
    return true;
  }

  void send_results() {
    for (const comm::Parcel& parcel : work_.take_results())
      send(parcel.rank, Kind::results, 0, {}, parcel.message);
  }

  void begin(std::uint32_t task) {
    units_not_begun_ -= work_.units_of(task);
    begin_(task, 0);
  }

  comm::Communicator& communicator_;
  DivisibleWork& work_;
  Asked asked_;
  TaskFunction begin_;
  std::function<void(std::uint32_t, int)> begin_task_ = [this](std::uint32_t task, int) {
    begin(task);
  };
  TaskRunner runner_;  // of tasks that are not begun
  ControlChannel control_;
  comm::Termination termination_;
  std::vector<int> others_;                // whom this rank asks
  std::vector<std::uint64_t> loads_;       // by rank, as last told; its own 0
  std::deque<int> unserved_;               // ranks that asked and got nothing
  std::vector<std::uint8_t> is_unserved_;  // by rank
  std::uint64_t units_not_begun_ = 0;      // of tasks in the runner
  int answers_to_come_ = 0;
  // Whom it asks when it has nothing to do: nobody from asking until units have come.
  enum class Next { wait, ask_others, ask_giver } next_ = Next::wait;
  int giver_ = 0;             // whose units came last
  bool asked_giver_ = false;  // and nobody else, the last time
};

}  // namespace

RankReport unit_stealing(comm::Communicator& communicator, const TaskGrid& tasks,
                         const ScheduleOptions& options, TaskFunction work, Asked asked) {
  return UnitThief(communicator, tasks, options, work, asked).run();
}

}  // namespace delray::loadbalance::internal
