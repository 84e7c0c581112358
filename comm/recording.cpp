// Passes each call on and appends what happened to the journal, timed by the communicator's clock.
// A receive from any source probes first, to learn the sender; a multicast is one event for each
// receiver, marked as repeated.
#include "comm/recording.h"

#include <utility>

#include "parallel/processor_time.h"

namespace delray::comm {

Recording::Recording(Communicator& inner, std::vector<Event>& events)
    : Recording(inner, std::make_shared<Journal>(Journal{&events, nullptr})) {}

Recording::Recording(Communicator& inner, Tally& tally)
    : Recording(inner, std::make_shared<Journal>(Journal{nullptr, &tally})) {}

Recording Recording::with_processor_time(Communicator& inner, std::vector<Event>& events) {
  return {inner, std::make_shared<Journal>(Journal{&events, nullptr, true})};
}

Recording::Recording(Communicator& inner, std::shared_ptr<Journal> journal)
    : ForwardingCommunicator(inner), journal_(std::move(journal)) {}

Recording::Recording(std::unique_ptr<Communicator> inner, std::shared_ptr<Journal> journal)
    : ForwardingCommunicator(std::move(inner)), journal_(std::move(journal)) {}

Recording::Begun Recording::begin() const {
  return {inner().seconds(), journal_->asks_processor ? parallel::processor_nanoseconds() : 0};
}

Event Recording::event(Event::Kind kind, const Begun& begun) const {
  Event event;
  event.kind = kind;
  event.phase = journal_->phase;
  event.round = journal_->round;
  event.begin = begun.seconds;
  event.end = inner().seconds();
  if (journal_->asks_processor)
    event.processor =
        1e-9 * static_cast<double>(parallel::processor_nanoseconds() - begun.processor);
  return event;
}

void Recording::write(const Event& event) {
  if (journal_->events) journal_->events->push_back(event);
  if (journal_->tally) journal_->tally->add(event);
}

void Recording::send(int to, Tag tag, Buffer&& message) {
  const std::uint64_t bytes = message.counted_bytes();
  const Begun begun = begin();
  inner().send(to, tag, std::move(message));
  Event sent = event(Event::Kind::send, begun);
  sent.peer = inner().world_rank(to);
  sent.tag = tag;
  sent.amount = bytes;
  write(sent);
}

void Recording::multicast(std::span<const int> to, Tag tag, Buffer&& message) {
  const std::uint64_t bytes = message.counted_bytes();
  const Begun begun = begin();
  inner().multicast(to, tag, std::move(message));
  Event sent = event(Event::Kind::send, begun);
  sent.tag = tag;
  sent.amount = bytes;
  for (const int rank : to) {
    sent.peer = inner().world_rank(rank);
    write(sent);
    sent.is_repeated = true;
    sent.begin = sent.end;
    sent.processor = 0;
  }
}

Buffer Recording::receive(int from_or_any, Tag tag_or_any) {
  const Begun begun = begin();
  int from = from_or_any;
  Tag tag = tag_or_any;
  if (from == kAnyRank || tag == kAnyTag) {
    // Only a probe tells who sent it.
    const auto envelope = inner().probe(from_or_any, tag_or_any, Deadline::never());
    from = envelope->source;
    tag = envelope->tag;
  }
  Buffer message = inner().receive(from, tag);
  Event received = event(Event::Kind::receive, begun);
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
  write(event(Event::Kind::mark, begin()));
}

void Recording::work(Work kind, std::uint64_t amount) {
  const Begun begun = begin();
  inner().work(kind, amount);
  Event worked = event(Event::Kind::work, begun);
  worked.work = kind;
  worked.amount = amount;
  write(worked);
}

}  // namespace delray::comm
