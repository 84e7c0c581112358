// Messages of work stealing and the detection of its end by counting units.
//
// Each rank starts with one unit and gains one for each task that it begins. Quiet ranks hand their
// units up a binomial tree; once rank 0 holds one for every task and every rank, all tasks are
// begun, and it sends the end down the tree. A rank that falls quiet sends one message, with the
// units from below added to its own.
#include "loadbalance/schedules/steal_protocol.h"

#include <cassert>
#include <cstring>

#include "comm/collectives.h"
#include "loadbalance/schedules/tags.h"

namespace delray::loadbalance::internal {
namespace {

struct Header {
  StealMessage::Kind kind;
  std::uint64_t value;
};

}  // namespace

StealProtocol::StealProtocol(comm::Communicator& communicator, TaskRunner& runner,
                             std::uint64_t tasks)
    : communicator_(communicator),
      runner_(runner),
      total_(tasks + static_cast<std::uint64_t>(communicator.size())) {}

void StealProtocol::send(int to, StealMessage::Kind kind, std::uint64_t value,
                         std::span<const TaskRange> tasks) {
  const Header header{kind, value};
  comm::Buffer message(sizeof(header) + tasks.size_bytes());
  std::memcpy(message.data(), &header, sizeof(header));
  if (!tasks.empty()) {
    std::memcpy(message.data() + sizeof(header), tasks.data(), tasks.size_bytes());
  }
  using Kind = StealMessage::Kind;
  if (kind == Kind::request_load || kind == Kind::request_tasks) {
    assert(holds_unit());
    ++runner_.report.requests;
  }
  runner_.send(to, kTagSteal, std::move(message));
}

std::optional<StealMessage> StealProtocol::next() {
  while (!over_) {
    const auto envelope = communicator_.probe(comm::kAnyRank, kTagSteal, comm::Deadline::now());
    if (!envelope) return std::nullopt;
    const comm::Buffer buffer = communicator_.receive(envelope->source, kTagSteal);
    Header header;
    std::memcpy(&header, buffer.data(), sizeof(header));
    StealMessage message{envelope->source, header.kind, header.value, {}};
    message.tasks.resize((buffer.size() - sizeof(header)) / sizeof(TaskRange));
    if (!message.tasks.empty()) {
      std::memcpy(message.tasks.data(), buffer.data() + sizeof(header),
                  buffer.size() - sizeof(header));
      ++runner_.report.steals;
      for (const TaskRange& range : message.tasks) runner_.report.tasks_stolen += range.count();
    }
    if (message.kind == StealMessage::Kind::begun) {
      units_ += message.value;
    } else if (message.kind == StealMessage::Kind::over) {
      end();
    } else {
      return message;
    }
    runner_.served();
  }
  return std::nullopt;
}

void StealProtocol::wait() { runner_.wait(comm::kAnyRank, kTagSteal); }

void StealProtocol::hand_up_units() {
  const std::uint64_t begun = runner_.begun();
  units_ += begun - counted_;
  counted_ = begun;
  const int rank = communicator_.rank();
  if (rank == 0) {
    if (units_ == total_) end();
  } else if (units_ > 0) {
    send(rank & (rank - 1), StealMessage::Kind::begun, units_);
    units_ = 0;
  }
}

RankReport StealProtocol::finish() {
  comm::barrier(communicator_);
  runner_.waited();
  return runner_.finish();
}

void StealProtocol::end() {
  over_ = true;
  const int rank = communicator_.rank();
  for (int step = 1; rank + step < communicator_.size() && (rank & step) == 0; step *= 2) {
    send(rank + step, StealMessage::Kind::over, 0);
  }
}

}  // namespace delray::loadbalance::internal
