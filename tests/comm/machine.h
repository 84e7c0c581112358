// The kinds of ranks that the tests of communicators run over.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "comm/communicator.h"

namespace delray::comm::testing {

using Body = std::function<void(Communicator&)>;

struct Machine {
  std::string name;
  int most_ranks;
  // Runs body on that many ranks, as often as there are seeds to try.
  std::function<void(int ranks, const Body&)> run;
  // Runs it once: for bodies that move much.
  std::function<void(int ranks, const Body&)> run_once;
  friend void PrintTo(const Machine& machine, std::ostream* out) { *out << machine.name; }
};

// Those that this test program has.
std::vector<Machine> machines();

}  // namespace delray::comm::testing
