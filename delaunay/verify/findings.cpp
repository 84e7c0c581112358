// Objections as messages: a head, then the sentence.
#include "delaunay/verify/findings.h"

#include <cstring>
#include <span>

#include "comm/collectives.h"

namespace delray::delaunay::internal {
namespace {

struct Head {
  PieceSimplex of;
  std::uint8_t exists = 0, has_simplex = 0, unknown_vertex = 0;
};

comm::Buffer pack(const std::optional<PieceObjection>& objection) {
  Head head;
  if (!objection) return comm::Buffer::of_value(head);
  head = {objection->of.value_or(PieceSimplex()), 1,
          objection->of ? std::uint8_t{1} : std::uint8_t{},
          objection->unknown_vertex ? std::uint8_t{1} : std::uint8_t{}};
  comm::Buffer message(sizeof head + objection->reason.size());
  std::memcpy(message.data(), &head, sizeof head);
  std::memcpy(message.data() + sizeof head, objection->reason.data(), objection->reason.size());
  return message;
}

std::optional<PieceObjection> unpack(const comm::Buffer& message) {
  Head head;
  std::memcpy(&head, message.data(), sizeof head);
  if (head.exists == 0) return std::nullopt;
  const auto* const text = reinterpret_cast<const char*>(message.data()) + sizeof head;
  return PieceObjection{head.has_simplex != 0 ? std::optional(head.of) : std::nullopt,
                        std::string(text, message.size() - sizeof head), head.unknown_vertex != 0};
}

}  // namespace

void Findings::agree(comm::Communicator& communicator) {
  for (auto* const each : {&invalid, &not_delaunay, &not_canonical}) {
    for (const comm::Buffer& message : comm::all_gather(communicator, pack(*each))) {
      if (auto found = unpack(message)) note(*each, *std::move(found));
    }
  }
}

}  // namespace delray::delaunay::internal
