// Counts each message once per receiver, as the ledger does, and takes the time that calls which
// may wait take for waiting.
#include "delaunay/distributed/counting.h"

#include <utility>

namespace delray::delaunay {

Counting::Counting(comm::Communicator& inner, MessageCounts& counts)
    : ForwardingCommunicator(inner), counts_(counts) {}

Counting::Counting(std::unique_ptr<comm::Communicator> inner, MessageCounts& counts)
    : ForwardingCommunicator(std::move(inner)), counts_(counts) {}

void Counting::count(int to, std::size_t bytes) {
  if (to == rank()) return;
  ++counts_.messages;
  counts_.bytes += bytes;
}

void Counting::send(int to, comm::Tag tag, comm::Buffer&& message) {
  count(to, message.counted_bytes());
  inner().send(to, tag, std::move(message));
}

void Counting::multicast(std::span<const int> to, comm::Tag tag, comm::Buffer&& message) {
  for (const int rank : to) count(rank, message.counted_bytes());
  inner().multicast(to, tag, std::move(message));
}

comm::Buffer Counting::receive(int from_or_any, comm::Tag tag_or_any) {
  const double begin = inner().seconds();
  comm::Buffer message = inner().receive(from_or_any, tag_or_any);
  counts_.waiting_seconds += inner().seconds() - begin;
  return message;
}

std::optional<comm::Envelope> Counting::probe(int from_or_any, comm::Tag tag_or_any,
                                              comm::Deadline deadline) {
  const double begin = inner().seconds();
  const auto envelope = inner().probe(from_or_any, tag_or_any, deadline);
  counts_.waiting_seconds += inner().seconds() - begin;
  return envelope;
}

std::unique_ptr<comm::Communicator> Counting::split(int color, int key) {
  return std::unique_ptr<comm::Communicator>(new Counting(inner().split(color, key), counts_));
}

}  // namespace delray::delaunay
