// Ranks and their messages: the only way that data gets from one rank to another.
//
// A Communicator belongs to one rank, and one thread at a time uses it: the rank's own, or those
// that take turns at a stage of a pipeline (MPI_THREAD_SERIALIZED). Collectives
// (comm/collectives.h) are free functions over it, so that every message is seen, counted and
// simulated. Implementations: comm/threads.h, comm/mpi.h, comm/simulated.h; comm/recording.h wraps
// any of them.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "comm/buffer.h"

namespace delray::comm {

// 0 <= tag < kReservedTags is the caller's; collectives use tags from kReservedTags on. kAnyTag
// stands for any of the caller's tags, never for a collective's: a rank that waits for anything
// does not take what a faster rank has already sent for the next collective.
using Tag = int;
inline constexpr int kAnyRank = -1;
inline constexpr Tag kAnyTag = -1;
inline constexpr Tag kReservedTags = 1 << 12;

// What is known of a message before it is received.
struct Envelope {
  int source = 0;
  Tag tag = 0;
  std::size_t bytes = 0;
};

// How long probe may wait: not at all, until a message is there, or for a time (of the virtual
// clock on the simulated machine).
struct Deadline {
  std::chrono::nanoseconds wait{0};
  static Deadline now() { return {std::chrono::nanoseconds{0}}; }
  static Deadline never() { return {std::chrono::nanoseconds::max()}; }
  static Deadline in(std::chrono::nanoseconds wait) { return {wait}; }
};

// The phase that a rank is in, for ledgers and timelines.
enum class Phase : std::uint8_t {
  other,
  load,
  transform,
  redistribute,
  bin,
  rasterize,
  trace,
  shade,
  compose,
  gather,
  collective,
};
inline constexpr int kPhases = static_cast<int>(Phase::collective) + 1;
const char* name(Phase phase);

// The units that `work` counts; the simulated machine turns an amount into time.
enum class Work : std::uint8_t {
  seconds_e9,  // nanoseconds that the caller measured or wishes to spend
  pixels_composited,
  primitives,
  fragments,
  rays,
  points,
  blocked_e9,  // nanoseconds that the caller waited for a device, its core being free for others
};
inline constexpr int kWorkKinds = 7;
const char* name(Work kind);

// REQUIRES for every rank: 0 <= rank < size().
class Communicator {
 public:
  virtual ~Communicator() = default;
  Communicator() = default;
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  virtual int rank() const = 0;
  virtual int size() const = 0;
  // The number that `rank` has in the run's first communicator, the one that was never split.
  virtual int world_rank(int rank) const = 0;
  // Time since the run began: wall-clock, or this rank's virtual clock on the simulated machine.
  // Code that measures itself asks here, so that it behaves alike on both.
  virtual double seconds() const = 0;

  // Hands `message` over; never blocks. A rank may send to itself. Any size, 2 GiB and more
  // included. Every message should be received before the communicator is destroyed.
  virtual void send(int to, Tag tag, Buffer&& message) = 0;
  // Sends one message to several ranks: counts as a send to each, in this order, and is one unless
  // the communicator knows better. A bus that all ranks listen to carries it once
  // (Network::is_bus()).
  virtual void multicast(std::span<const int> to, Tag tag, Buffer&& message);
  // Returns once nothing that this rank has sent needs it any more: it may turn to other things for
  // long, and nobody waits for it. Takes in what arrives meanwhile. Where processes of a machine
  // outnumber its cores also, for 50 ms at most, once they have taken what lies in memory that they
  // share. REQUIRES: each rank that has not received all of it yet is in a call of the
  // communicator, or comes to one by itself.
  virtual void finish_sends() {}
  // Waits for a message and takes it; first in, first out per source and tag.
  virtual Buffer receive(int from_or_any, Tag tag_or_any) = 0;
  // The next message that receive(envelope.source, envelope.tag) would take, without waiting for
  // the rest of it, left in place; nothing when none has arrived whole before the deadline.
  virtual std::optional<Envelope> probe(int from_or_any, Tag tag_or_any, Deadline deadline) = 0;

  // Collective: ranks that give the same colour form a communicator, ordered by key, then rank.
  virtual std::unique_ptr<Communicator> split(int color, int key) = 0;

  // Everything until the next mark belongs to this phase and round.
  virtual void mark(Phase phase, int round) = 0;
  virtual void work(Work kind, std::uint64_t amount) = 0;

  // What `compute` gives, which is the same on every rank: all call this, in the same order with
  // regard to other calls of it. A machine whose ranks take turns on one thread may compute it once
  // for all of them; elsewhere each does. REQUIRES: compute does not use the communicator.
  using Replica = std::shared_ptr<const void>;
  virtual Replica replicate(const std::function<Replica()>& compute) { return compute(); }

  // Ends all ranks; the launcher reports `why` with this rank's number (exit code 5).
  [[noreturn]] virtual void abort(std::string why) = 0;
};

}  // namespace delray::comm
