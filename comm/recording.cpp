// Passes each call on and appends what happened to the journal, timed by the communicator's clock.
// A receive from any source probes first, to learn the sender; a multicast is one event for each
// receiver, marked as repeated.
#include "comm/recording.h"

#include <utility>

namespace delray::comm {

Recording::Recording(Communicator& inner, std::vector<Event>& events)
    : ForwardingCommunicator(inner), journal_(new Journal{&events, nullptr}) {}

Recording::Recording(Communicator& inner, Tally& tally)
    : ForwardingCommunicator(inner), journal_(new Journal{nullptr, &tally}) {}

Recording::Recording(std::unique_ptr<Communicator> inner, std::shared_ptr<Journal> journal)
    : ForwardingCommunicator(std::move(inner)), journal_(std::move(journal)) {}

Event Recording::event(Event::Kind kind, double begin) const {
  Event event;
  event.kind = kind;
  event.phase = journal_->phase;
  event.round = journal_->round;
  event.begin = begin;
  event.end = inner().seconds();
  return event;
}

void Recording::write(const Event& event) {
  if (journal_->events) journal_->events->push_back(event);
  if (journal_->tally) journal_->tally->add(event);
}

void Recording::send(int to, Tag tag, Buffer&& message) {
  const std::uint64_t bytes = message.counted_bytes();
  const double begin = inner().seconds();
  inner().send(to, tag, std::move(message));
  Event sent = event(Event::Kind::send, begin);
  sent.peer = inner().world_rank(to);
  sent.tag = tag;
  sent.amount = bytes;
  write(sent);
}

void Recording::multicast(std::span<const int> to, Tag tag, Buffer&& message) {
  const std::uint64_t bytes = message.counted_bytes();
  const double begin = inner().seconds();
  inner().multicast(to, tag, std::move(message));
  Event sent = event(Event::Kind::send, begin);
  sent.tag = tag;
  sent.amount = bytes;
  for (const int rank : to) {
    sent.peer = inner().world_rank(rank);
    write(sent);
    sent.is_repeated = true;
    sent.begin = sent.end;
  }
}

Buffer Recording::receive(int from_or_any, Tag tag_or_any) {
  const double begin = inner().seconds();
  int from = from_or_any;
  Tag tag = tag_or_any;
  if (from == kAnyRank || tag == kAnyTag) {
    // Only a probe tells who sent it.
    const auto envelope = inner().probe(from_or_any, tag_or_any, Deadline::never());
    from = envelope->source;
    tag = envelope->tag;
  }
  Buffer message = inner().receive(from, tag);
  Event received = event(Event::Kind::receive, begin);
  received.peer = inner().world_rank(from);
  received.tag = tag;
  received.amount = message.counted_bytes();
  write(received);
  return message;
}

std::unique_ptr<Communicator> Recording::split(int color, int key) {
  return std::unique_ptr<Communicator>(new Recording(inner().split(color, key), journal_));
}

void Recording::mark(Phase phase, int round) {
  inner().mark(phase, round);
  journal_->phase = phase;
  journal_->round = round;
  write(event(Event::Kind::mark, inner().seconds()));
}

void Recording::work(Work kind, std::uint64_t amount) {
  const double begin = inner().seconds();
  inner().work(kind, amount);
  Event worked = event(Event::Kind::work, begin);
  worked.work = kind;
  worked.amount = amount;
  write(worked);
}

}  // namespace delray::comm
