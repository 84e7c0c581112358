// Limits of inputs, to the memory and the files that they may use: --memory and --allow-outside.
#pragma once

#include <cstdint>
#include <string>

#include "files/memory_budget.h"
#include "files/resolve.h"

namespace CLI {
class App;
}

namespace delray::apps {

struct InputLimits {
  std::uint64_t memory = 0;  // bytes that a process may have; 0: half of its share of the machine
  bool allow_outside = false;

  files::MemoryBudget budget() const;
  files::Outside outside() const;
};

// Adds --memory.
void add_memory_option(CLI::App& command, InputLimits& limits);

// Adds --allow-outside, for commands that read scenes.
void add_outside_option(CLI::App& command, InputLimits& limits);

// Throws UsageError if --allow-outside was given with a file that cannot name others.
void refuse_outside(const std::string& path, const InputLimits& limits);

}  // namespace delray::apps
