// Multicast in its general form, one message for each receiver, and the names of phases and of
// work.
#include "comm/communicator.h"

#include <utility>

namespace delray::comm {

void Communicator::multicast(std::span<const int> to, Tag tag, Buffer&& message) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    send(to[i], tag, i + 1 < to.size() ? message.copy() : std::move(message));
  }
}

const char* name(Phase phase) {
  switch (phase) {
    case Phase::other:
      return "other";
    case Phase::load:
      return "load";
    case Phase::transform:
      return "transform";
    case Phase::redistribute:
      return "redistribute";
    case Phase::bin:
      return "bin";
    case Phase::rasterize:
      return "rasterize";
    case Phase::trace:
      return "trace";
    case Phase::shade:
      return "shade";
    case Phase::compose:
      return "compose";
    case Phase::gather:
      return "gather";
    case Phase::collective:
      return "collective";
  }
  return "unknown";
}

const char* name(Work kind) {
  switch (kind) {
    case Work::seconds_e9:
      return "nanoseconds";
    case Work::pixels_composited:
      return "pixels composited";
    case Work::primitives:
      return "primitives";
    case Work::fragments:
      return "fragments";
    case Work::rays:
      return "rays";
    case Work::points:
      return "points";
    case Work::blocked_e9:
      return "nanoseconds blocked";
  }
  return "unknown";
}

}  // namespace delray::comm
