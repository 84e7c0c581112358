// Messages between MPI processes: small ones as they are, large ones between processes of a machine
// by their place in shared memory, and those above the size of a piece in pieces after an
// announcement. All use non-blocking sends and matched probes, so no call waits for another rank.
#include "comm/mpi/mpi_port.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <string>
#include <utility>

#include "comm/collectives.h"

namespace delray::comm::internal {
namespace {

static_assert(kEndOfReservedTags <= kTagsPerContext);

// How many contexts tags can tell apart.
int most_contexts(MPI_Comm communicator) {
  const int* largest_tag = nullptr;
  int is_known = 0;
  MPI_Comm_get_attr(communicator, MPI_TAG_UB, static_cast<void*>(&largest_tag), &is_known);
  return is_known ? static_cast<int>((std::int64_t{*largest_tag} + 1) / kTagsPerContext) : 0;
}

}  // namespace

Port::Port(Engine& engine, MPI_Comm communicator, std::vector<int> root_ranks)
    : engine_(engine),
      communicator_(communicator),
      most_contexts_(std::min(most_contexts(communicator), engine.options.most_contexts)),
      root_ranks_(std::move(root_ranks)) {
  MPI_Comm_rank(communicator_, &rank_);
}

Port::Queue& Port::open(int context) { return queues_[context]; }

void Port::close(int context) {
  const auto at = queues_.find(context);
  for (Transfer& transfer : at->second.take_all()) keep(std::move(transfer));
  queues_.erase(at);
}

void Port::close_all() {
  for (auto& [unused, queue] : queues_) {
    for (Transfer& transfer : queue.take_all()) keep(std::move(transfer));
  }
}

// MPI may still be writing messages that nobody asked for.
void Port::keep(Transfer&& incoming) {
  if (!completed(incoming.requests)) engine_.unfinished.push_back(std::move(incoming));
}

void Port::send(int to, int context, Tag tag, Buffer&& message) {
  assert(0 <= tag && tag < kTagsPerContext);
  engine_.reap();
  const int mpi_tag = context * kTagsPerContext + tag;
  const std::size_t piece = engine_.options.piece_bytes;
  if (message.size() >= piece) {
    const LongMessage announcement{mpi_tag, message.size(), piece};
    start_send(to, kTagLong, Buffer::of_value(announcement), sizeof announcement);
    start_send(to, kTagPiece, std::move(message), piece);
    return;
  }
  if (engine_.local_ranks.count(root_rank(to)) > 0) {
    const std::size_t bytes = message.size();
    if (const auto place = lend(message)) {
      const SharedMessage announcement{mpi_tag, *place, bytes};
      start_send(to, kTagShared, Buffer::of_value(announcement), sizeof announcement);
      return;
    }
  }
  start_send(to, mpi_tag, std::move(message), piece);
}

// REQUIRES: piece >= 1. An empty message is one piece.
void Port::start_send(int to, int mpi_tag, Buffer&& message, std::size_t piece) {
  Transfer& outgoing = engine_.unfinished.emplace_back();
  outgoing.buffer = std::move(message);
  std::size_t begin = 0;
  do {
    const std::size_t count = std::min(piece, outgoing.buffer.size() - begin);
    MPI_Isend(outgoing.buffer.data() + begin, static_cast<int>(count), MPI_BYTE, to, mpi_tag,
              communicator_, &outgoing.requests.emplace_back());
    begin += count;
  } while (begin < outgoing.buffer.size());
  const auto local_rank = engine_.local_ranks.find(root_rank(to));
  if (local_rank != engine_.local_ranks.end()) ring(local_rank->second);
}

void Port::pull() {
  // Up to this size every transport sends the bytes along with the envelope.
  constexpr int kSurelyHere = 256;
  for (;;) {
    int found = 0;
    MPI_Message handle;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, communicator_, &found, &handle, &status);
    if (!found) return;
    if (status.MPI_TAG == kTagLong) {
      pull_long(handle, status.MPI_SOURCE);
    } else if (status.MPI_TAG == kTagShared) {
      pull_shared(handle, status.MPI_SOURCE);
    } else {
      int bytes = 0;
      MPI_Get_count(&status, MPI_BYTE, &bytes);
      Transfer incoming{Buffer(static_cast<std::size_t>(bytes)), {}};
      if (bytes <= kSurelyHere) {
        MPI_Mrecv(incoming.buffer.data(), bytes, MPI_BYTE, &handle, MPI_STATUS_IGNORE);
      } else {
        MPI_Imrecv(incoming.buffer.data(), bytes, MPI_BYTE, &handle,
                   &incoming.requests.emplace_back());
      }
      push(status.MPI_SOURCE, status.MPI_TAG, std::move(incoming));
    }
  }
}

void Port::push(int source, std::int64_t tag, Transfer&& incoming) {
  const int context = static_cast<int>(tag / kTagsPerContext);
  const auto at = queues_.find(context);
  if (at == queues_.end() && context < next_context_) return keep(std::move(incoming));
  Queue& queue = at != queues_.end() ? at->second : queues_[context];
  queue.push(source, static_cast<Tag>(tag % kTagsPerContext), 0, std::move(incoming));
}

void Port::pull_shared(MPI_Message& handle, int source) {
  SharedMessage announcement{};
  MPI_Mrecv(&announcement, sizeof announcement, MPI_BYTE, &handle, MPI_STATUS_IGNORE);
  const auto local_rank = engine_.local_ranks.find(root_rank(source));
  std::optional<Buffer> message;
  if (local_rank != engine_.local_ranks.end()) {
    message = borrow(local_rank->second, announcement.place, announcement.bytes);
  }
  if (!message) {
    engine_.end("rank " + std::to_string(root_rank(source)) +
                " told of a message that its memory does not have, or that is out of reach");
  }
  push(source, announcement.tag, {std::move(*message), {}});
}

void Port::pull_long(MPI_Message& handle, int source) {
  LongMessage announcement{};
  MPI_Mrecv(&announcement, sizeof announcement, MPI_BYTE, &handle, MPI_STATUS_IGNORE);
  Transfer incoming{Buffer(announcement.bytes), {}};
  const std::size_t piece = announcement.piece;  // the sender's
  for (std::size_t begin = 0; begin < announcement.bytes; begin += piece) {
    const std::size_t count = std::min<std::size_t>(piece, announcement.bytes - begin);
    MPI_Irecv(incoming.buffer.data() + begin, static_cast<int>(count), MPI_BYTE, source, kTagPiece,
              communicator_, &incoming.requests.emplace_back());
  }
  push(source, announcement.tag, std::move(incoming));
}

}  // namespace delray::comm::internal
