// Ranks that are to work together find out whether they are at the same work.
#pragma once

#include <span>
#include <string>

#include "comm/communicator.h"

namespace delray::comm {

// Something that has to be the same on all ranks: what it is, in words for the user, and what it is
// here. "--size", "640x480".
struct Fact {
  std::string what, value;
};

// Collective, and the first that ranks do together: returns where all of them have the same facts.
// Otherwise all throw std::invalid_argument (as comm/agree_on_failure.h does), which names the
// lowest rank that differs from rank 0, in what, what it is on both, and how many more ranks
// differ. One all-reduce of 32 bytes where nothing differs; the facts travel down a tree where
// something does: O(log n) rounds, nothing that grows with the square of n. No two facts have one
// name.
void handshake(Communicator& communicator, std::span<const Fact> facts);

}  // namespace delray::comm
