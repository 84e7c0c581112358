// Memory that processes of one machine share, so that a message between them is handed over rather
// than copied: the sender writes it there in the first place, and the receiver reads it there.
//
// A process has at most one piece of such memory, of which take_memory takes large blocks once it
// is there. It is a file without a name (memfd_create), which ends with the processes that have it
// open, however they end.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "comm/communicator.h"

namespace delray::comm::internal {

// Where others find a process's memory. Travels as it is.
struct SharedMemory {
  std::int64_t process = 0;
  std::int32_t file = -1;  // of the process; -1: it has none
  std::int32_t unused = 0;
  std::uint64_t token = 0;  // stands at its beginning
};

// This process's, made by the first call. Any thread.
SharedMemory share_memory();

// Whether this process can reach that of another. Any thread; costs a look-up once it was. Takes a
// page of this process's address space; all of the other's memory is mapped when a message in it
// comes, and copied from where there is too little address space for that.
bool can_reach(const SharedMemory& other);

// Hands over a message whose bytes are in this process's memory and tells where they are; nothing,
// and the message is left as it is, where they are not.
std::optional<std::uint64_t> lend(Buffer& message);

// What the other process has lent. Its memory goes back when the buffer is destroyed, or at once
// where a copy was made. Nothing when there is no such message in its memory, or it is out of
// reach.
//
// REQUIRES: called once for what one call of lend there has told. Throws std::bad_alloc.
std::optional<Buffer> borrow(const SharedMemory& other, std::uint64_t offset, std::size_t bytes);

// Whoever waits sleeps until somebody rings, with a message that he has just sent.
//
// A process counts how often it was rung for. It reads the count, looks for messages, and if there
// are none sleeps until the count is another or so much time has passed.
// REQUIRES for these two: this process shares its memory.
std::uint32_t rings();
void sleep_until_rung(std::uint32_t rings_seen, std::chrono::microseconds longest);
// Nothing where this process cannot reach the other, which then has ended.
void ring(const SharedMemory& other);

// What a process shows the node-local ranks of itself, for messages about stalls.
inline constexpr std::int32_t kWaitsForNobody = -2;  // it works, or is lost
struct Doing {
  Phase phase = Phase::other;
  std::int32_t waits_for = kWaitsForNobody;  // a rank, or kAnyRank
};
// REQUIRES for these two: this process shares its memory.
void publish_phase(Phase phase);
void publish_waiting(std::int32_t for_rank);
// Nothing where the other is out of reach.
std::optional<Doing> doing(const SharedMemory& other);

}  // namespace delray::comm::internal
