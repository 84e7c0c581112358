// A sequential discrete-event simulation of ranks that are fibers on one thread, under the LogGP
// model (Alexandrov, Ionescu, Schauser and Scheiman 1995), with links that messages wait for.
//
// A set orders the ranks that can go on by virtual time, ties by random numbers from the seed. A
// rank runs until it must wait: for a message from any source it waits until no other rank can send
// an earlier one, and where ranks share a bus or cores it takes its turn in the order of time. On
// networks with routes a message comes to each of its links in the order of time, too. O(log ranks
// + log messages) per message, O(log messages on their way) per link of its route.
//
// Degenerate: when no rank can go on and some have not returned, they are deadlocked and the first
// of them is reported.
#include "comm/simulated.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "comm/collectives.h"
#include "comm/in_process/fiber.h"
#include "comm/in_process/flights.h"
#include "comm/in_process/group.h"
#include "comm/transport/first_failure.h"

namespace delray::comm {
namespace {

using internal::Fiber;
using internal::Group;
using Message = internal::MessageQueue<Buffer>::Message;

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kLeastProbe = 100e-9;
// For so long a rank keeps a core that it shares, while others want it: about what Linux gives.
constexpr double kSlice = 3e-3;

struct Rank {
  double clock = 0;
  double slowness = 1;
  double outgoing_free = 0, incoming_free = 0;  // when the rank's link has carried all so far
  Phase phase = Phase::other;
  std::unique_ptr<Fiber> fiber;

  // What it is suspended for, if it is, and until when.
  const Group* group = nullptr;
  int from = 0;
  Tag tag = 0;
  double limit = kNever;

  // Its place among those that will run: at virtual time `wake`.
  bool scheduled = false;
  double wake = 0;
  std::uint64_t order = 0;
};

class Machine {
 public:
  Machine(int count, const Network& given, std::uint64_t seed, const SimulationOptions& options)
      : network(given),
        ranks(count),
        random_(seed),
        bus_free_(static_cast<std::size_t>(given.topology.channels)),
        core_free_(static_cast<std::size_t>(given.shared_cores)) {
    if (kind_of(given.topology.shape).has_routes) flights.emplace(given, count);
    for (std::size_t i = 0; i < ranks.size() && i < options.slowness.size(); ++i) {
      ranks[i].slowness = options.slowness[i];
    }
  }

  const Network network;
  std::vector<Rank> ranks;  // indexed by world rank
  internal::FirstFailure failure;
  std::optional<internal::Flights> flights;  // on networks with routes

  void schedule(int rank, double wake) {
    Rank& r = ranks[rank];
    if (r.scheduled) ready_.erase({r.wake, r.order, rank});
    r.scheduled = true;
    r.wake = wake;
    r.order = random_();
    ready_.insert({r.wake, r.order, rank});
  }

  // Whether everything that happens before `time` has happened.
  bool is_settled(double time) const { return time < next_wake() && time < next_flight(); }

  // Runs ranks in the order of their wake times until nobody is left who could, and moves messages
  // on that come to a link before.
  void run() {
    while (!failure.happened()) {
      if (next_flight() <= next_wake() && next_flight() < kNever) {
        if (std::optional<internal::Flight> landed = flights->move_on()) land(std::move(*landed));
        continue;
      }
      if (ready_.empty()) break;
      const int rank = std::get<int>(*ready_.begin());
      ready_.erase(ready_.begin());
      ranks[rank].scheduled = false;
      ranks[rank].fiber->resume();
    }
    if (!failure.happened()) report_deadlock();
    for (Rank& rank : ranks) {
      while (failure.happened() && !rank.fiber->finished()) rank.fiber->resume();
    }
  }

  bool takes_turns() const { return network.is_bus() || network.shared_cores > 0; }

  // The rank's processor is busy for so long, once it gets a core.
  // REQUIRES: where cores are shared, nobody is left who could want one earlier.
  void occupy(Rank& rank, double seconds) {
    seconds *= rank.slowness;
    if (core_free_.empty()) {
      rank.clock += seconds;
      return;
    }
    const auto core = std::min_element(core_free_.begin(), core_free_.end());
    *core = rank.clock = std::max(rank.clock, *core) + seconds;
  }

  // Of the processor, on either side of a message.
  double handling_seconds(std::size_t bytes) const {
    return network.overhead + network.copy_seconds_per_byte * static_cast<double>(bytes);
  }

  // When the last byte of a message that is sent now arrives at a link that is free.
  // REQUIRES: as occupy; the sender's processor has handled it.
  double arrival(int from, int to, std::size_t bytes) {
    Rank& sender = ranks[from];
    if (from == to) return sender.clock;
    double& link_free =
        network.is_bus() ? *std::ranges::min_element(bus_free_) : sender.outgoing_free;
    link_free =
        std::max(sender.clock, link_free) + network.seconds_per_byte * static_cast<double>(bytes);
    return late(from, to, link_free + network.latency);
  }

  // Puts a message of a group into the queue of `to`, and wakes that rank if it waits for it.
  void deliver(const std::shared_ptr<Group>& group, int from, int to, Tag tag, double arrival,
               Buffer&& message) {
    group->queues[to].push(from, tag, arrival, std::move(message));
    const int receiver = group->world_ranks[to];
    const Rank& r = ranks[receiver];
    if (r.group != group.get() || !internal::matches(from, tag, r.from, r.tag)) return;
    const double wake = std::min(r.limit, std::max(r.clock, arrival));
    if (!r.scheduled || wake < r.wake) schedule(receiver, wake);
  }

  // The result of a group's call number `call` of replicate.
  Communicator::Replica replica(const Group* group, int size, std::uint64_t call,
                                const std::function<Communicator::Replica()>& compute) {
    const auto [at, is_first] = replicas_.try_emplace({group, call});
    if (is_first) at->second = {compute(), size};
    Communicator::Replica result = at->second.result;
    if (--at->second.left == 0) replicas_.erase(at);
    return result;
  }

  // REQUIRES: the message has arrived at the receiver's clock.
  void carry_in(int to, const Message& message) {
    Rank& receiver = ranks[to];
    if (network.topology.shape != Shape::crossbar) return;
    const double seconds =
        network.seconds_per_byte * static_cast<double>(message.payload.counted_bytes());
    receiver.incoming_free = std::max(message.arrival - seconds, receiver.incoming_free) + seconds;
    receiver.clock = std::max(receiver.clock, receiver.incoming_free);
  }

 private:
  double next_wake() const { return ready_.empty() ? kNever : std::get<double>(*ready_.begin()); }
  double next_flight() const { return flights ? flights->next() : kNever; }

  void land(internal::Flight&& flight) {
    const std::vector<int>& world = flight.group->world_ranks;
    const double arrival = late(world[flight.from], world[flight.to], flight.time);
    deliver(flight.group, flight.from, flight.to, flight.tag, arrival, std::move(flight.message));
  }

  // When a message of world ranks arrives that would at `time`, which is random with jitter.
  double late(int from, int to, double time) {
    if (network.jitter <= 0) return time;
    double& last =
        last_arrival_[static_cast<std::uint64_t>(from) << 32 | static_cast<std::uint64_t>(to)];
    return last = std::max(time + jitter(), last);
  }

  // Log-uniform, so that a message may be late by a little or by more than all others together. No
  // library function that could differ between machines.
  double jitter() {
    const std::uint64_t bits = random_();
    const double fraction = 0.5 + static_cast<double>(bits >> 12) * 0x1p-53;
    return std::ldexp(network.jitter * fraction, -static_cast<int>(bits % 16));
  }

  void report_deadlock() {
    int first = -1, others = 0;
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      if (ranks[i].fiber->finished()) continue;
      if (first < 0) {
        first = static_cast<int>(i);
      } else {
        ++others;
      }
    }
    if (first < 0) return;
    std::string why = "deadlock: it waits for a message from " +
                      internal::describe_pattern(ranks[first].from, ranks[first].tag);
    if (others > 0) why += ", and " + std::to_string(others) + " more rank(s) wait in vain";
    failure.record(first, ranks[first].phase, std::move(why));
  }

  struct Replicated {
    Communicator::Replica result;
    int left = 0;  // ranks that have not come for it
  };
  std::map<std::pair<const Group*, std::uint64_t>, Replicated> replicas_;
  std::mt19937_64 random_;
  std::set<std::tuple<double, std::uint64_t, int>> ready_;
  std::unordered_map<std::uint64_t, double> last_arrival_;
  std::vector<double> bus_free_;   // when each channel of the bus has carried all so far
  std::vector<double> core_free_;  // when each of the shared cores has done all so far
};

class SimulatedCommunicator final : public Communicator {
 public:
  SimulatedCommunicator(Machine& machine, std::shared_ptr<Group> group, int rank)
      : machine_(machine),
        group_(std::move(group)),
        rank_(rank),
        own_(machine.ranks[group_->world_ranks[rank]]) {}

  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(group_->world_ranks.size()); }
  int world_rank(int rank) const override { return group_->world_ranks[rank]; }
  double seconds() const override { return own_.clock; }

  void send(int to, Tag tag, Buffer&& message) override {
    internal::check_message(to, size(), tag);
    if (machine_.failure.happened()) throw RunEnded{};
    if (to != rank_) {
      occupy(machine_.handling_seconds(message.counted_bytes()));
      if (machine_.flights) {
        machine_.flights->start({group_, rank_, to, tag, own_.clock, std::move(message)});
        return;
      }
      wait_for_turn();
    }
    const double arrival =
        machine_.arrival(world_rank(rank_), world_rank(to), message.counted_bytes());
    deliver(to, tag, arrival, std::move(message));
  }

  void multicast(std::span<const int> to, Tag tag, Buffer&& message) override {
    const auto other = std::find_if(to.begin(), to.end(), [&](int rank) { return rank != rank_; });
    if (!machine_.network.is_bus() || other == to.end()) {
      Communicator::multicast(to, tag, std::move(message));
      return;
    }
    if (machine_.failure.happened()) throw RunEnded{};
    const Buffer taken = std::move(message);
    occupy(machine_.handling_seconds(taken.counted_bytes()));
    wait_for_turn();
    const double arrival =
        machine_.arrival(world_rank(rank_), world_rank(*other), taken.counted_bytes());
    for (const int rank : to)
      deliver(rank, tag, rank == rank_ ? own_.clock : arrival, taken.copy());
  }

  Buffer receive(int from_or_any, Tag tag_or_any) override {
    Message* message = wait(from_or_any, tag_or_any, kNever);
    if (message->source != rank_) {
      machine_.carry_in(world_rank(rank_), *message);
      occupy(machine_.handling_seconds(message->payload.counted_bytes()));
    }
    return group_->queues[rank_].take(message);
  }

  std::optional<Envelope> probe(int from_or_any, Tag tag_or_any, Deadline deadline) override {
    const double longest = deadline.wait == std::chrono::nanoseconds::max()
                               ? kNever
                               : std::chrono::duration<double>(deadline.wait).count();
    const Message* message = wait(from_or_any, tag_or_any, own_.clock + std::max(longest, 0.0));
    if (message) return Envelope{message->source, message->tag, message->payload.counted_bytes()};
    if (longest < kLeastProbe) {
      own_.clock += std::max(kLeastProbe, machine_.network.overhead) * own_.slowness;
    }
    return std::nullopt;
  }

  std::unique_ptr<Communicator> split(int color, int key) override {
    group_->post_split(rank_, color, key);
    barrier(*this);
    auto [group, rank] = group_->take_split(rank_);
    return std::make_unique<SimulatedCommunicator>(machine_, std::move(group), rank);
  }

  void mark(Phase phase, int) override { own_.phase = phase; }
  void work(Work kind, std::uint64_t amount) override {
    const double seconds = machine_.network.seconds_per_work[static_cast<std::size_t>(kind)] *
                           static_cast<double>(amount);
    if (kind == Work::blocked_e9) {
      own_.clock += seconds;
    } else {
      occupy(seconds);
    }
  }

  // Computed by the rank that comes first, and kept until the last has come.
  Replica replicate(const std::function<Replica()>& compute) override {
    return machine_.replica(group_.get(), size(), replicated_++, compute);
  }

  void abort(std::string why) override {
    machine_.failure.record(world_rank(rank_), own_.phase, std::move(why));
    throw RunEnded{};
  }

 private:
  void deliver(int to, Tag tag, double arrival, Buffer&& message) {
    machine_.deliver(group_, rank_, to, tag, arrival, std::move(message));
  }

  // Lets all ranks go on that are not as far in time, where ranks compete for something.
  void wait_for_turn() {
    if (!machine_.takes_turns() || machine_.is_settled(own_.clock)) return;
    machine_.schedule(world_rank(rank_), own_.clock);
    own_.fiber->suspend();
    if (machine_.failure.happened()) throw RunEnded{};
  }

  void occupy(double seconds) {
    if (machine_.network.shared_cores == 0) {
      if (seconds > 0) machine_.occupy(own_, seconds);
      return;
    }
    for (; seconds > 0; seconds -= kSlice) {
      wait_for_turn();
      machine_.occupy(own_, std::min(seconds, kSlice));
    }
  }

  // The message that receive would take, the clock moved on to its arrival; null and the clock at
  // `limit` when there is none by then.
  Message* wait(int from, Tag tag, double limit) {
    double settled = -kNever;  // everything that happens before has happened
    for (;;) {
      if (machine_.failure.happened()) throw RunEnded{};
      Message* message = group_->queues[rank_].find(from, tag);
      const double time = message ? std::min(limit, std::max(own_.clock, message->arrival)) : limit;
      // Messages of one source stay in order, so nothing can come before the one that is there.
      // Else it must be certain that nobody sends one that arrives earlier.
      const bool is_certain = message != nullptr && from != kAnyRank;
      if (is_certain || (time < kNever && (time <= settled || machine_.is_settled(time)))) {
        own_.clock = time;
        return message && message->arrival <= time ? message : nullptr;
      }
      suspend(from, tag, limit, time);
      settled = own_.wake;
    }
  }

  void suspend(int from, Tag tag, double limit, double time) {
    own_.group = group_.get();
    own_.from = from;
    own_.tag = tag;
    own_.limit = limit;
    if (time < kNever) machine_.schedule(world_rank(rank_), time);
    own_.fiber->suspend();
    own_.group = nullptr;
  }

  Machine& machine_;
  std::shared_ptr<Group> group_;
  int rank_;
  Rank& own_;
  std::uint64_t replicated_ = 0;  // calls of replicate
};

void run_rank(Machine& machine, const std::shared_ptr<Group>& group, int rank,
              const std::function<void(Communicator&)>& body) {
  if (machine.failure.happened()) return;
  try {
    SimulatedCommunicator communicator(machine, group, rank);
    body(communicator);
  } catch (const RunEnded&) {
  } catch (...) {
    machine.failure.record(rank, machine.ranks[rank].phase, std::current_exception());
  }
}

}  // namespace

Network any_order() {
  Network network;
  network.latency = network.overhead = network.seconds_per_byte = 0;
  network.jitter = 1e-3;
  return network;
}

std::vector<double> run_simulated(int ranks, const Network& network, std::uint64_t seed,
                                  const std::function<void(Communicator&)>& body,
                                  const SimulationOptions& options) {
  if (ranks < 1) throw std::invalid_argument("ranks: there is at least one");
  Machine machine(ranks, network, seed, options);
  std::vector<int> members(ranks);
  std::iota(members.begin(), members.end(), 0);
  const auto group = std::make_shared<Group>(std::move(members));
  for (int rank = 0; rank < ranks; ++rank) {
    machine.ranks[rank].fiber = std::make_unique<Fiber>(
        options.stack_bytes, [&, rank] { run_rank(machine, group, rank, body); });
    machine.schedule(rank, 0);
  }
  machine.run();
  machine.failure.rethrow_if_any();
  std::vector<double> finished;
  finished.reserve(machine.ranks.size());
  for (const Rank& rank : machine.ranks) finished.push_back(rank.clock);
  return finished;
}

}  // namespace delray::comm
