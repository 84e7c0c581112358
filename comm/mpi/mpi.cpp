// The communicator over MPI: receiving, waiting, splitting and ending, on top of the queues of
// mpi_port.h.
//
// A rank that waits pulls everything that has come into queues and backs off between attempts. A
// split needs one all_gather and no collective of MPI: ranks agree on a context number, which
// becomes part of the tags. At the end every rank takes in messages until a non-blocking barrier
// says that all sends are complete (Hoefler, Siebert and Lumsdaine 2010).
//
// Degenerate: without context numbers left a split makes an MPI communicator; a rank that leaves by
// an exception of its own skips the barrier, as others would wait in vain.
#include "comm/mpi.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "comm/collectives.h"
#include "comm/mpi/mpi_end.h"
#include "comm/mpi/mpi_engine.h"
#include "comm/mpi/mpi_port.h"
#include "comm/transport/block_pool.h"
#include "comm/transport/first_failure.h"

namespace delray::comm {
namespace {

using internal::Backoff;
using internal::Clock;
using internal::completed;
using internal::Engine;
using internal::kWaitsForNobody;
using internal::Port;
using internal::PublishedWait;
using internal::Transfer;
using internal::Wait;

class MpiCommunicator final : public Communicator {
 public:
  // `members` are ranks of the port.
  MpiCommunicator(std::shared_ptr<Engine> engine, Port& port, int context, std::vector<int> members)
      : engine_(std::move(engine)),
        port_(port),
        context_(context),
        members_(std::move(members)),
        queue_(port.open(context)) {
    for (int rank = 0; rank < size(); ++rank) {
      const auto member = static_cast<std::size_t>(members_[static_cast<std::size_t>(rank)]);
      if (member >= ranks_.size()) ranks_.resize(member + 1, kAnyRank);
      ranks_[member] = rank;
    }
    rank_ = ranks_[static_cast<std::size_t>(port_.rank())];
  }

  ~MpiCommunicator() override {
    const bool is_root = context_ == 0 && &port_ == engine_->ports.front().get();
    if (!is_root) {
      port_.close(context_);
    } else if (std::uncaught_exceptions() == 0) {
      drain();
    } else {
      // An exception of this rank alone: the others would be waited for in vain, and MPI still uses
      // the buffers. The process is about to end.
      [[maybe_unused]] auto* leaked = new std::shared_ptr<Engine>(engine_);
    }
  }

  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(members_.size()); }
  int world_rank(int rank) const override { return port_.root_rank(member(rank)); }
  double seconds() const override {
    return std::chrono::duration<double>(Clock::now() - engine_->start).count();
  }

  void send(int to, Tag tag, Buffer&& message) override {
    internal::check_message(to, size(), tag);
    if (to == rank_) {
      queue_.push(port_.rank(), tag, 0, {std::move(message), {}});
    } else {
      port_.send(member(to), context_, tag, std::move(message));
    }
  }

  void finish_sends() override {
    const PublishedWait published(*engine_, kAnyRank);
    const Wait waited(engine_->options.timeout);
    engine_->finish_some();
    for (Backoff backoff(*engine_); !engine_->unfinished.empty(); backoff.pause(true)) {
      if (waited.is_over()) end_stalled(waited, "its messages to be taken");
      for (const auto& port : engine_->ports) port->pull();
      engine_->finish_some();
    }
    if (!engine_->cores_are_scarce) return;
    // Who turns to other things takes the core from ranks that have yet to take what they got.
    // Sleeping, as the system takes a rank that yields to want no core for long; and not until it
    // is woken, as then all would be woken onto the core of who does it.
    constexpr std::chrono::milliseconds kLongest{50};
    constexpr std::chrono::microseconds kBetweenLooks{200};
    const Wait late(kLongest);
    for (;;) {
      const std::size_t lent = internal::block_pool().lent();
      std::size_t& kept = engine_->kept_by_others;  // is not waited for again
      if (late.is_over() || lent < kept) kept = lent;
      if (lent <= kept) break;
      std::this_thread::sleep_for(kBetweenLooks);
      for (const auto& port : engine_->ports) port->pull();
      engine_->finish_some();
    }
  }

  Buffer receive(int from_or_any, Tag tag_or_any) override {
    Message* message = wait(from_or_any, tag_or_any, Deadline::never(), /*whole=*/false);
    const int source = port_.root_rank(message->source);
    const Tag tag = message->tag;
    Transfer incoming = queue_.take(message);
    if (completed(incoming.requests)) return std::move(incoming.buffer);
    const PublishedWait published(*engine_, source);
    const Wait waited(engine_->options.timeout);
    Backoff backoff(*engine_);
    while (!completed(incoming.requests)) {
      if (waited.is_over()) end_stalled(waited, source, tag);
      backoff.pause(/*on_their_way=*/true);
    }
    return std::move(incoming.buffer);
  }

  std::optional<Envelope> probe(int from_or_any, Tag tag_or_any, Deadline deadline) override {
    const Message* message = wait(from_or_any, tag_or_any, deadline, /*whole=*/true);
    if (!message) return std::nullopt;
    return Envelope{ranks_[static_cast<std::size_t>(message->source)], message->tag,
                    message->payload.buffer.size()};
  }

  // A message or two to each of a few ranks; MPI hears of it only where it has no contexts left.
  std::unique_ptr<Communicator> split(int color, int key) override {
    struct Choice {
      int color, key, next_context;
    };
    const Choice mine{color, key, port_.next_context()};
    std::vector<Choice> choices;
    for (const Buffer& buffer : all_gather(*this, Buffer::of_value(mine))) {
      choices.push_back(buffer.as<Choice>()[0]);
    }
    int context = 0;
    std::vector<int> chosen;  // ranks of this communicator
    for (int rank = 0; rank < size(); ++rank) {
      const Choice& choice = choices[static_cast<std::size_t>(rank)];
      context = std::max(context, choice.next_context);
      if (choice.color == color) chosen.push_back(rank);
    }
    std::stable_sort(chosen.begin(), chosen.end(), [&](int a, int b) {
      return choices[static_cast<std::size_t>(a)].key < choices[static_cast<std::size_t>(b)].key;
    });
    if (!port_.has_context(context)) return split_port(chosen);
    port_.used_context(context);
    for (int& rank : chosen) rank = member(rank);
    return std::make_unique<MpiCommunicator>(engine_, port_, context, std::move(chosen));
  }

  void mark(Phase phase, int) override {
    engine_->phase = phase;
    internal::note_phase(phase);
    if (!engine_->local_ranks.empty()) internal::publish_phase(phase);
  }
  void work(Work, std::uint64_t) override {}

  void abort(std::string why) override { engine_->end(why); }

 private:
  using Message = Port::Queue::Message;

  int member(int rank) const { return members_[static_cast<std::size_t>(rank)]; }
  int root_rank_or_any(int rank) const { return rank == kAnyRank ? kAnyRank : world_rank(rank); }

  // The same by MPI, among those `chosen`, ranks of this communicator.
  std::unique_ptr<Communicator> split_port(const std::vector<int>& chosen) {
    std::vector<int> members, root_ranks;
    for (const int rank : chosen) {
      members.push_back(world_rank(rank));
      root_ranks.push_back(world_rank(rank));
    }
    MPI_Group all = MPI_GROUP_NULL, own = MPI_GROUP_NULL;
    MPI_Comm part = MPI_COMM_NULL;
    MPI_Comm_group(engine_->for_splits, &all);
    MPI_Group_incl(all, static_cast<int>(members.size()), members.data(), &own);
    MPI_Comm_create_group(engine_->for_splits, own, /*tag=*/0, &part);
    MPI_Group_free(&own);
    MPI_Group_free(&all);
    engine_->ports.push_back(std::make_shared<Port>(*engine_, part, std::move(root_ranks)));
    std::iota(members.begin(), members.end(), 0);
    return std::make_unique<MpiCommunicator>(engine_, *engine_->ports.back(), 0,
                                             std::move(members));
  }

  // The first message that matches; with `whole` when all of it has come.
  Message* find(int from, Tag tag, bool whole) {
    Message* message = queue_.find(from == kAnyRank ? kAnyRank : member(from), tag);
    return !whole || message == nullptr || completed(message->payload.requests) ? message : nullptr;
  }

  Message* wait(int from, Tag tag, Deadline deadline, bool whole) {
    if (Message* message = find(from, tag, whole)) return message;
    const bool forever = deadline.wait == std::chrono::nanoseconds::max();
    const PublishedWait published(*engine_, forever ? root_rank_or_any(from) : kWaitsForNobody);
    const Wait stalled(engine_->options.timeout), late(deadline.wait);
    Backoff backoff(*engine_);
    for (bool first = true;; first = false) {
      const std::uint32_t rings_seen = backoff.rings();
      port_.pull();
      if (Message* message = find(from, tag, whole)) return message;
      if (engine_->options.progress != nullptr && engine_->options.progress->stop_requested()) {
        throw parallel::Interrupted{};
      }
      if (deadline.wait <= std::chrono::nanoseconds{0}) return nullptr;
      engine_->reap();
      if (!first && late.is_over()) return nullptr;
      if (!first && stalled.is_over()) end_stalled(stalled, root_rank_or_any(from), tag);
      const bool is_coming = find(from, tag, /*whole=*/false) != nullptr;
      backoff.pause(is_coming || !engine_->unfinished.empty(), rings_seen);
    }
  }

  // `from` is a rank of the root, or any.
  [[noreturn]] void end_stalled(const Wait& waited, int from, Tag tag) const {
    engine_->end_stalled("stalled: rank " + std::to_string(engine_->root_rank) + " waited " +
                             waited.text() + " for a message from " +
                             internal::describe_pattern(from, tag),
                         from);
  }

  [[noreturn]] void end_stalled(const Wait& waited, const char* what_for) const {
    engine_->end_stalled("stalled: rank " + std::to_string(engine_->root_rank) + " waited " +
                             waited.text() + " for " + what_for,
                         kAnyRank);
  }

  // Collective: returns once the sends of all ranks are complete. Every rank keeps taking messages
  // until all have said that theirs are out (the idea of NBX: Hoefler, Siebert and Lumsdaine 2010).
  void drain() {
    MPI_Request everybody = MPI_REQUEST_NULL;
    bool finished_mine = false;
    int finished_all = 0;
    {
      const PublishedWait published(*engine_, kAnyRank);
      const Wait waited(engine_->options.timeout);
      for (Backoff backoff(*engine_); !finished_all; backoff.pause(!finished_mine)) {
        if (waited.is_over()) end_stalled(waited, "the others to end");
        for (const auto& port : engine_->ports) port->pull();
        engine_->finish_some();
        if (!finished_mine && engine_->unfinished.empty()) {
          finished_mine = true;
          MPI_Ibarrier(engine_->root, &everybody);
        }
        if (finished_mine) MPI_Test(&everybody, &finished_all, MPI_STATUS_IGNORE);
      }
    }
    // What the others have sent by now is complete on their side, but perhaps not on this one.
    for (const auto& port : engine_->ports) port->close_all();
    for (Backoff backoff(*engine_); !engine_->unfinished.empty(); backoff.pause()) {
      engine_->finish_some();
    }
    MPI_Comm_free(&engine_->for_splits);
    for (const auto& port : engine_->ports) {
      MPI_Comm communicator = port->communicator();
      MPI_Comm_free(&communicator);
    }
  }

  std::shared_ptr<Engine> engine_;
  Port& port_;
  int context_, rank_ = 0;
  std::vector<int> members_;  // by rank
  std::vector<int> ranks_;    // by member; kAnyRank of those that are none
  Port::Queue& queue_;
};

}  // namespace

std::unique_ptr<Communicator> make_mpi_communicator(const void* mpi_communicator,
                                                    const MpiOptions& options) {
  if (options.piece_bytes < 1 || options.piece_bytes >= (std::size_t{1} << 31)) {
    throw std::invalid_argument("piece_bytes: from 1 to 2^31 - 1");
  }
  const auto engine = std::make_shared<Engine>();
  engine->options = options;
  MPI_Comm_dup(*static_cast<const MPI_Comm*>(mpi_communicator), &engine->root);
  MPI_Comm_dup(engine->root, &engine->for_splits);
  MPI_Comm_rank(engine->root, &engine->root_rank);
  internal::look_at_this_machine(*engine);
  int size = 0;
  MPI_Comm_size(engine->root, &size);
  std::vector<int> everybody(static_cast<std::size_t>(size));
  std::iota(everybody.begin(), everybody.end(), 0);
  engine->ports.push_back(std::make_shared<Port>(*engine, engine->root, everybody));
  return std::make_unique<MpiCommunicator>(engine, *engine->ports.front(), 0, std::move(everybody));
}

}  // namespace delray::comm
