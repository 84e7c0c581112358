#include "loadbalance/schedules/theft.h"

#include <cassert>
#include <cstring>

#include "loadbalance/schedules/tags.h"

namespace delray::loadbalance::internal {
namespace {

struct Header {
  TheftMessage::Kind kind;
  std::uint64_t value;
};

}  // namespace

Theft::Theft(comm::Communicator& communicator, Crew& crew, std::uint64_t tasks)
    : communicator_(communicator),
      crew_(crew),
      total_(tasks + static_cast<std::uint64_t>(communicator.size())) {}

void Theft::send(int to, TheftMessage::Kind kind, std::uint64_t value,
                 std::span<const TaskRange> tasks) {
  const Header header{kind, value};
  comm::Buffer message(sizeof(header) + tasks.size_bytes());
  std::memcpy(message.data(), &header, sizeof(header));
  if (!tasks.empty()) {
    std::memcpy(message.data() + sizeof(header), tasks.data(), tasks.size_bytes());
  }
  using Kind = TheftMessage::Kind;
  if (kind == Kind::ask_load || kind == Kind::ask_tasks) {
    assert(holds_unit());
    ++crew_.report.requests;
  }
  crew_.send(to, kTagSteal, std::move(message));
}

std::optional<TheftMessage> Theft::next() {
  while (!over_) {
    const auto envelope = communicator_.probe(comm::kAnyRank, kTagSteal, comm::Deadline::now());
    if (!envelope) return std::nullopt;
    const comm::Buffer buffer = communicator_.receive(envelope->source, kTagSteal);
    Header header;
    std::memcpy(&header, buffer.data(), sizeof(header));
    TheftMessage message{envelope->source, header.kind, header.value, {}};
    message.tasks.resize((buffer.size() - sizeof(header)) / sizeof(TaskRange));
    if (!message.tasks.empty()) {
      std::memcpy(message.tasks.data(), buffer.data() + sizeof(header),
                  buffer.size() - sizeof(header));
      ++crew_.report.steals;
      for (const TaskRange& range : message.tasks) crew_.report.tasks_stolen += range.count();
    }
    if (message.kind == TheftMessage::Kind::begun) {
      units_ += message.value;
    } else if (message.kind == TheftMessage::Kind::over) {
      end();
    } else {
      return message;
    }
    crew_.served();
  }
  return std::nullopt;
}

void Theft::wait() { crew_.wait(comm::kAnyRank, kTagSteal); }

void Theft::quiet() {
  const std::uint64_t begun = crew_.begun();
  units_ += begun - counted_;
  counted_ = begun;
  const int rank = communicator_.rank();
  if (rank == 0) {
    if (units_ == total_) end();
  } else if (units_ > 0) {
    send(rank & (rank - 1), TheftMessage::Kind::begun, units_);
    units_ = 0;
  }
}

void Theft::end() {
  over_ = true;
  const int rank = communicator_.rank();
  for (int step = 1; rank + step < communicator_.size() && (rank & step) == 0; step *= 2) {
    send(rank + step, TheftMessage::Kind::over, 0);
  }
}

}  // namespace delray::loadbalance::internal
