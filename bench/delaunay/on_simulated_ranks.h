// Simulated ranks of which a benchmark counts something.
#pragma once

#include <cstddef>
#include <functional>

#include "comm/simulated.h"
#include "parallel/arena.h"

namespace delray::bench {

// Runs body(communicator) on so many ranks, one at a time in one thread, with stacks that thousands
// of them have room for.
inline void on_simulated_ranks(int ranks, const std::function<void(comm::Communicator&)>& body) {
  comm::SimulationOptions simulation;
  simulation.stack_bytes = std::size_t{8} << 20;
  parallel::Arena(1).execute([&] { comm::run_simulated(ranks, {}, 1, body, simulation); });
}

}  // namespace delray::bench
