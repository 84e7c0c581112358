// Options that limit the memory that inputs take and the files that they may name.
#include "apps/options/input_limits.h"

#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>

#include "apps/launch.h"
#include "apps/options/help.h"
#include "apps/session.h"

namespace delray::apps {
namespace {

// Keeps what is resident near what is used. What is freed can be used again only within its arena
// of the heap, and each thread takes one of its own while it may: pages of a pack that one thread
// reads and another drops would leave each of them half empty. Large blocks, such as pictures, go
// back to the system at once: in the heap small ones settle between them, and it grows with every
// frame. To be called before there are threads.
void keep_heap_small(std::uint64_t memory) {
  constexpr std::uint64_t kMemoryPerArena = std::uint64_t{512} << 20, kMost = 1024;
  constexpr int kLarge = 4 << 20;
  mallopt(M_ARENA_MAX,
          static_cast<int>(std::clamp(memory / kMemoryPerArena, std::uint64_t{1}, kMost)));
  mallopt(M_MMAP_THRESHOLD, kLarge);
  mallopt(M_TRIM_THRESHOLD, kLarge);
}

}  // namespace

files::MemoryBudget InputLimits::budget() const {
  if (memory > 0) return files::MemoryBudget(memory);
  return files::MemoryBudget(files::MemoryBudget().limit() /
                             static_cast<std::uint64_t>(processes_here()));
}

files::Outside InputLimits::outside() const {
  return allow_outside ? files::Outside::allowed : files::Outside::refused;
}

void add_memory_option(CLI::App& command, InputLimits& limits) {
  command
      .add_option_function<std::string>(
          "--memory",
          [&limits](const std::string& text) {
            limits.memory = files::parse_bytes(text);
            if (limits.memory > 0) return keep_heap_small(limits.memory);
            throw CLI::ValidationError(
                "--memory", fmt::format("'{}' is not a size such as 500MB or 2GiB", text));
          },
          "Maximum memory of a process, such as 500MB or 2GiB; inputs that need more are refused "
          "(default: half of the machine's memory, divided among its processes)")
      ->group(group::kInput)
      ->type_name("SIZE");
}

void add_outside_option(CLI::App& command, InputLimits& limits) {
  command
      .add_flag("--allow-outside", limits.allow_outside,
                "Let a scene use textures, buffers and materials outside of its own folder")
      ->group(group::kInput);
}

void refuse_outside(const std::string& path, const InputLimits& limits) {
  if (!limits.allow_outside) return;
  throw UsageError(fmt::format("--allow-outside is for scenes; {} names no other files", path));
}

}  // namespace delray::apps
