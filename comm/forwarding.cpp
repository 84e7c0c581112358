// Passes every call on, unchanged.
#include "comm/forwarding.h"

#include <exception>
#include <utility>

namespace delray::comm {

int ForwardingCommunicator::rank() const { return inner_.rank(); }
int ForwardingCommunicator::size() const { return inner_.size(); }
int ForwardingCommunicator::world_rank(int rank) const { return inner_.world_rank(rank); }
double ForwardingCommunicator::seconds() const { return inner_.seconds(); }

void ForwardingCommunicator::send(int to, Tag tag, Buffer&& message) {
  inner_.send(to, tag, std::move(message));
}

void ForwardingCommunicator::multicast(std::span<const int> to, Tag tag, Buffer&& message) {
  inner_.multicast(to, tag, std::move(message));
}

void ForwardingCommunicator::finish_sends() { inner_.finish_sends(); }

Buffer ForwardingCommunicator::receive(int from_or_any, Tag tag_or_any) {
  return inner_.receive(from_or_any, tag_or_any);
}

std::optional<Envelope> ForwardingCommunicator::probe(int from_or_any, Tag tag_or_any,
                                                      Deadline deadline) {
  return inner_.probe(from_or_any, tag_or_any, deadline);
}

std::unique_ptr<Communicator> ForwardingCommunicator::split(int color, int key) {
  return inner_.split(color, key);
}

void ForwardingCommunicator::mark(Phase phase, int round) { inner_.mark(phase, round); }

void ForwardingCommunicator::work(Work kind, std::uint64_t amount) { inner_.work(kind, amount); }

Communicator::Replica ForwardingCommunicator::replicate(const std::function<Replica()>& compute) {
  return inner_.replicate(compute);
}

void ForwardingCommunicator::abort(std::string why) {
  inner_.abort(std::move(why));
  std::terminate();  // not reached; not every compiler sees that
}

}  // namespace delray::comm
