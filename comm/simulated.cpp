#include "comm/simulated.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "comm/collectives.h"
#include "comm/internal/fiber.h"
#include "comm/internal/first_failure.h"
#include "comm/internal/group.h"

namespace delray::comm {
namespace {

using internal::Fiber;
using internal::Group;
using Message = internal::MessageQueue<Buffer>::Message;

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kLeastProbe = 100e-9;

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
      : network(given), ranks(count), random_(seed) {
    for (std::size_t i = 0; i < ranks.size() && i < options.slowness.size(); ++i) {
      ranks[i].slowness = options.slowness[i];
    }
  }

  const Network network;
  std::vector<Rank> ranks;  // indexed by world rank
  internal::FirstFailure failure;

  void schedule(int rank, double wake) {
    Rank& r = ranks[rank];
    if (r.scheduled) ready_.erase({r.wake, r.order, rank});
    r.scheduled = true;
    r.wake = wake;
    r.order = random_();
    ready_.insert({r.wake, r.order, rank});
  }

  // Whether everything that happens before `time` has happened.
  bool is_settled(double time) const {
    return ready_.empty() || time < std::get<double>(*ready_.begin());
  }

  // Runs ranks in the order of their wake times until nobody is left who could.
  void run() {
    while (!ready_.empty() && !failure.happened()) {
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

  // When the last byte of a message that is sent now arrives at a link that is free.
  double arrival(int from, int to, std::size_t bytes) {
    Rank& sender = ranks[from];
    if (from == to) return sender.clock;
    sender.clock += network.overhead * sender.slowness;
    const double start = std::max(sender.clock, sender.outgoing_free);
    sender.outgoing_free = start + network.seconds_per_byte * static_cast<double>(bytes);
    double time = sender.outgoing_free + network.latency;
    if (network.jitter > 0) {
      time += jitter();
      double& last =
          last_arrival_[static_cast<std::uint64_t>(from) << 32 | static_cast<std::uint64_t>(to)];
      time = last = std::max(time, last);
    }
    return time;
  }

  // REQUIRES: the message has arrived at the receiver's clock.
  void charge_receive(int from, int to, const Message& message) {
    if (from == to) return;
    Rank& receiver = ranks[to];
    const double seconds = network.seconds_per_byte * static_cast<double>(message.payload.size());
    receiver.incoming_free = std::max(message.arrival - seconds, receiver.incoming_free) + seconds;
    receiver.clock =
        std::max(receiver.clock, receiver.incoming_free) + network.overhead * receiver.slowness;
  }

 private:
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

  std::mt19937_64 random_;
  std::set<std::tuple<double, std::uint64_t, int>> ready_;
  std::unordered_map<std::uint64_t, double> last_arrival_;
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
    assert(0 <= to && to < size() && tag >= 0);
    if (machine_.failure.happened()) throw RunEnded{};
    const int receiver = world_rank(to);
    const double arrival = machine_.arrival(world_rank(rank_), receiver, message.size());
    group_->queues[to].push(rank_, tag, arrival, std::move(message));
    const Rank& r = machine_.ranks[receiver];
    if (r.group != group_.get() || !internal::matches(rank_, tag, r.from, r.tag)) return;
    const double wake = std::min(r.limit, std::max(r.clock, arrival));
    if (!r.scheduled || wake < r.wake) machine_.schedule(receiver, wake);
  }

  Buffer receive(int from_or_any, Tag tag_or_any) override {
    Message* message = wait(from_or_any, tag_or_any, kNever);
    machine_.charge_receive(world_rank(message->source), world_rank(rank_), *message);
    return group_->queues[rank_].take(message);
  }

  std::optional<Envelope> probe(int from_or_any, Tag tag_or_any, Deadline deadline) override {
    const double longest = deadline.wait == std::chrono::nanoseconds::max()
                               ? kNever
                               : std::chrono::duration<double>(deadline.wait).count();
    const Message* message = wait(from_or_any, tag_or_any, own_.clock + std::max(longest, 0.0));
    if (message) return Envelope{message->source, message->tag, message->payload.size()};
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
    own_.clock += machine_.network.seconds_per_work[static_cast<std::size_t>(kind)] *
                  static_cast<double>(amount) * own_.slowness;
  }

  void abort(std::string why) override {
    machine_.failure.record(world_rank(rank_), own_.phase, std::move(why));
    throw RunEnded{};
  }

 private:
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
  assert(ranks >= 1);
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
