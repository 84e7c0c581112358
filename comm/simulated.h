// Ranks of a simulated machine: a discrete-event simulation that runs real code under a virtual
// clock.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "comm/communicator.h"
#include "comm/failure.h"
#include "comm/network.h"

namespace delray::comm {

// For tests: nothing costs time but the way of a message, which is random. Over the seeds every
// order of arrival occurs that MPI allows: first in, first out between two ranks, else any.
Network any_order();

// Properties of the simulated ranks.
struct SimulationOptions {
  // Rank k needs slowness[k] times as long for its work and overheads; 1 where the vector ends.
  std::vector<double> slowness;
  // Per rank; pages that are never touched cost nothing.
  std::size_t stack_bytes = std::size_t{1} << 20;
};

// Runs body(communicator) for each of `ranks` ranks, one at a time on the calling thread, and
// returns the virtual time at which each returned. Time passes only in messages, work() and
// probing; an unsuccessful probe that does not wait costs 100 ns or one overhead, so that polling
// ends. Equal arguments give equal runs; the seed decides the jitter and what happens first of what
// happens at one moment.
//
// Failures end the run as in run_threads; a deadlock is always found. O(log ranks + log messages)
// per message, a switch between ranks only where one has to wait. Throws
// std::invalid_argument for no ranks. REQUIRES: the body
// does not call its communicator while it holds a lock or from inside Arena::execute (all ranks
// share the thread, and one such scope would be left in the middle of another).
std::vector<double> run_simulated(int ranks, const Network& network, std::uint64_t seed,
                                  const std::function<void(Communicator&)>& body,
                                  const SimulationOptions& options = {});

}  // namespace delray::comm
