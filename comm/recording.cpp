#include "comm/recording.h"

#include <exception>
#include <utility>

namespace delray::comm {

Recording::Recording(Communicator& inner, std::vector<Event>& events)
    : inner_(inner), journal_(new Journal{events}) {}

Recording::Recording(std::unique_ptr<Communicator> inner, std::shared_ptr<Journal> journal)
    : owned_(std::move(inner)), inner_(*owned_), journal_(std::move(journal)) {}

Event& Recording::append(Event::Kind kind, double begin) {
  Event event;
  event.kind = kind;
  event.phase = journal_->phase;
  event.round = journal_->round;
  event.begin = begin;
  event.end = inner_.seconds();
  return journal_->events.emplace_back(event);
}

void Recording::send(int to, Tag tag, Buffer&& message) {
  const std::uint64_t bytes = message.size();
  const double begin = inner_.seconds();
  inner_.send(to, tag, std::move(message));
  Event& event = append(Event::Kind::send, begin);
  event.peer = inner_.world_rank(to);
  event.tag = tag;
  event.amount = bytes;
}

Buffer Recording::receive(int from_or_any, Tag tag_or_any) {
  const double begin = inner_.seconds();
  int from = from_or_any;
  Tag tag = tag_or_any;
  if (from == kAnyRank || tag == kAnyTag) {
    // Only a probe tells who sent it.
    const auto envelope = inner_.probe(from_or_any, tag_or_any, Deadline::never());
    from = envelope->source;
    tag = envelope->tag;
  }
  Buffer message = inner_.receive(from, tag);
  Event& event = append(Event::Kind::receive, begin);
  event.peer = inner_.world_rank(from);
  event.tag = tag;
  event.amount = message.size();
  return message;
}

std::optional<Envelope> Recording::probe(int from_or_any, Tag tag_or_any, Deadline deadline) {
  return inner_.probe(from_or_any, tag_or_any, deadline);
}

std::unique_ptr<Communicator> Recording::split(int color, int key) {
  return std::unique_ptr<Communicator>(new Recording(inner_.split(color, key), journal_));
}

void Recording::mark(Phase phase, int round) {
  inner_.mark(phase, round);
  journal_->phase = phase;
  journal_->round = round;
  append(Event::Kind::mark, inner_.seconds());
}

void Recording::work(Work kind, std::uint64_t amount) {
  const double begin = inner_.seconds();
  inner_.work(kind, amount);
  Event& event = append(Event::Kind::work, begin);
  event.work = kind;
  event.amount = amount;
}

void Recording::abort(std::string why) {
  inner_.abort(std::move(why));
  std::terminate();  // not reached; not every compiler sees that
}

}  // namespace delray::comm
