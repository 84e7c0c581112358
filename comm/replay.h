// Predicting the time of a recorded run on another network.
#pragma once

#include <vector>

#include "comm/ledger.h"
#include "comm/network.h"

namespace delray::comm {

// Sends messages of the recorded sizes and does the recorded work (Work::seconds_e9 as it is, other
// kinds at the network's prices) in the recorded order: exact for code that would do the same on
// the network, whatever comes first there. Returns when each rank is done. O(log ranks) per event.
//
// REQUIRES: a ledger of a whole run, in which every message that was sent was received.
std::vector<double> replay(const Ledger& ledger, const Network& network);

}  // namespace delray::comm
