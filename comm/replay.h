// Predicting the time of a recorded run on another network.
#pragma once

#include <array>
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

// Seconds of a rank in a phase. Handling is the processor's at messages; waiting is all else: for
// others, for links, and for a core where ranks share some.
struct PhaseSeconds {
  double work = 0, handling = 0, waiting = 0;
  double all() const { return work + handling + waiting; }
};
// The time of a rank by its phases.
struct ReplayedRank {
  double end = 0;                              // the sum of all phases
  std::array<PhaseSeconds, kPhases> phases{};  // indexed by Phase
  const PhaseSeconds& in(Phase phase) const { return phases[static_cast<std::size_t>(phase)]; }
};
// The same with where every rank's time goes.
std::vector<ReplayedRank> replay_phases(const Ledger& ledger, const Network& network);

}  // namespace delray::comm
