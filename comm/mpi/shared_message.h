// Announcements that MPI carries in place of long and of shared messages, and the layout of tags.
#pragma once

#include <cstdint>

namespace delray::comm::internal {

// Communicators that were split from one share an MPI communicator: a message of context k with tag
// t has the tag k * kTagsPerContext + t there. The tags below are of no context: 3 is left out.
// Every MPI allows tags to 32767, those that are in use some 2^28 or more.
inline constexpr int kTagsPerContext = 1 << 13;
inline constexpr int kFirstSplitContext = 4;  // 0 is of the communicator that was not split

inline constexpr int kTagLong = 32000;    // announces a message that travels in pieces
inline constexpr int kTagPiece = 32001;   // a piece of the announced message
inline constexpr int kTagShared = 32002;  // announces a message in shared memory
static_assert(kTagShared < kFirstSplitContext * kTagsPerContext);

struct LongMessage {
  std::int64_t tag;  // of context and message
  std::uint64_t bytes;
  std::uint64_t piece;  // bytes of each, but for the last
};

struct SharedMessage {
  std::int64_t tag;     // of context and message
  std::uint64_t place;  // as lend told it
  std::uint64_t bytes;
};

}  // namespace delray::comm::internal
