// What travels through MPI of a message in shared memory.
#pragma once

#include <cstdint>

namespace delray::comm::internal {

inline constexpr int kTagShared = 32002;  // of MPI

struct SharedMessage {
  std::int64_t tag;     // of the message
  std::uint64_t place;  // as lend told it
  std::uint64_t bytes;
};

}  // namespace delray::comm::internal
