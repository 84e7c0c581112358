// An MPI communicator, and the messages of all communicators that share it.
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "comm/mpi/mpi_engine.h"
#include "comm/mpi/mpi_header.h"
#include "comm/mpi/shared_message.h"
#include "comm/transport/message_queue.h"

namespace delray::comm::internal {

// Ranks are those of the MPI communicator.
//
// Its matching is not used: whatever has come is moved into the queue of its context, so that
// waiting for one message makes room for all others, and sends of any size complete.
class Port {
 public:
  // `root_ranks`: what the port's ranks are in the engine's root. Never frees `communicator`.
  Port(Engine& engine, MPI_Comm communicator, std::vector<int> root_ranks);

  using Queue = MessageQueue<Transfer>;

  MPI_Comm communicator() const { return communicator_; }
  int rank() const { return rank_; }
  int root_rank(int rank) const { return root_ranks_[static_cast<std::size_t>(rank)]; }

  // The queue of a context, there as long as it is open. Messages of one that ranks have not opened
  // here yet wait for that; those of one that was closed are dropped.
  Queue& open(int context);
  void close(int context);
  void close_all();

  // Contexts are given to all ranks of a split alike, each the least that none of them has had yet.
  int next_context() const { return next_context_; }
  bool has_context(int context) const { return context < most_contexts_; }
  void used_context(int context) { next_context_ = context + 1; }

  // REQUIRES: to is another rank.
  void send(int to, int context, Tag tag, Buffer&& message);
  // Moves everything that has come into the queues. Order per source is kept: MPI does not let a
  // message overtake another of the same source that a wildcard probe would match.
  void pull();

 private:
  void start_send(int to, int mpi_tag, Buffer&& message, std::size_t piece);
  void push(int source, std::int64_t tag, Transfer&& incoming);
  void keep(Transfer&& incoming);
  void pull_shared(MPI_Message& handle, int source);
  void pull_long(MPI_Message& handle, int source);

  Engine& engine_;
  MPI_Comm communicator_;
  int rank_ = 0, next_context_ = kFirstSplitContext, most_contexts_ = 0;
  std::vector<int> root_ranks_;
  std::unordered_map<int, Queue> queues_;
};

}  // namespace delray::comm::internal
