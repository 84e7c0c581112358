// The machines that tests of communicators run on within one process.
#include <gtest/gtest.h>

#include "comm/simulated.h"
#include "comm/threads.h"
#include "tests/comm/machine.h"

namespace delray::comm::testing {
namespace {

// ThreadSanitizer takes a hundred times as long to make a fiber, and looks for nothing that seeds
// change.
#if defined(__SANITIZE_THREAD__)
constexpr std::uint64_t kSeeds = 5;
#else
constexpr std::uint64_t kSeeds = 100;
#endif

void run_over_threads(int ranks, const Body& body) { run_threads(ranks, 1, body); }

void run_over_seeds(int ranks, const Body& body) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    run_simulated(ranks, any_order(), seed, body);
    if (::testing::Test::HasFailure()) return;
  }
}

void run_over_a_network(int ranks, const Body& body) { run_simulated(ranks, Network{}, 1, body); }

}  // namespace

std::vector<Machine> machines() {
  return {{"threads", 9, run_over_threads, run_over_threads},
          {"simulated", 9, run_over_seeds, run_over_a_network},
          {"simulated_network", 9, run_over_a_network, run_over_a_network}};
}

}  // namespace delray::comm::testing
