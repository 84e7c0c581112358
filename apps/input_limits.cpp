#include "apps/input_limits.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "apps/launch.h"
#include "apps/session.h"

namespace delray::apps {
namespace {

struct Unit {
  std::string_view name;
  double bytes;
};
constexpr double kKibi = 1024, kKilo = 1000;
constexpr std::array kUnits = {
    Unit{"", 1},
    Unit{"B", 1},
    Unit{"K", kKibi},
    Unit{"KB", kKilo},
    Unit{"KIB", kKibi},
    Unit{"M", kKibi* kKibi},
    Unit{"MB", kKilo* kKilo},
    Unit{"MIB", kKibi* kKibi},
    Unit{"G", kKibi* kKibi* kKibi},
    Unit{"GB", kKilo* kKilo* kKilo},
    Unit{"GIB", kKibi* kKibi* kKibi},
    Unit{"T", kKibi* kKibi* kKibi* kKibi},
    Unit{"TB", kKilo* kKilo* kKilo* kKilo},
    Unit{"TIB", kKibi* kKibi* kKibi* kKibi},
};

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
            limits.memory = parse_bytes(text);
            if (limits.memory > 0) return;
            throw CLI::ValidationError(
                "--memory", fmt::format("'{}' is not a size such as 500MB or 2GiB", text));
          },
          "Largest amount of memory that a process may use, such as 500MB or 2GiB; an input that "
          "needs more is refused (default: half of the machine's memory, shared among its "
          "processes)")
      ->type_name("SIZE");
}

void add_outside_option(CLI::App& command, InputLimits& limits) {
  command.add_flag("--allow-outside", limits.allow_outside,
                   "Let a scene use textures, buffers and materials outside of its own folder");
}

void refuse_outside(const std::string& path, const InputLimits& limits) {
  if (!limits.allow_outside) return;
  throw UsageError(fmt::format("--allow-outside is for scenes; {} names no other files", path));
}

std::uint64_t parse_bytes(const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || !(number > 0)) return 0;
  std::string name(rest, end);
  for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  for (const Unit& unit : kUnits) {
    const double bytes = number * unit.bytes;
    if (unit.name == name) return bytes < 0x1p63 ? static_cast<std::uint64_t>(bytes) : 0;
  }
  return 0;
}

}  // namespace delray::apps
