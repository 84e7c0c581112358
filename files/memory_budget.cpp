// Resident memory is read from /proc/self/statm, the machine's from /proc/meminfo and the files of
// control groups, version 1 and 2 (cgroups(7)): the least limit of the group and those above it.
#include "files/memory_budget.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "files/error.h"

namespace delray::files {
namespace {

constexpr std::uint64_t kNoLimit = ~std::uint64_t{0};

// Below this many bytes of a thread nobody looks at what is resident, which takes microseconds.
constexpr std::uint64_t kWorthLooking = std::uint64_t{1} << 20;

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

std::uint64_t physical_memory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || size <= 0) return kNoLimit;
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size);
}

// The number in a file, or none for "max" and files that are not there.
std::uint64_t limit_in(const std::filesystem::path& file) {
  std::uint64_t limit = 0;
  return std::ifstream(file) >> limit ? limit : kNoLimit;
}

// The least limit of a group and of those that it is in. In a container the group's path may be
// that of the machine outside, of which only the end, or nothing, is there.
std::uint64_t least_limit(const std::filesystem::path& root, std::filesystem::path group,
                          const char* file) {
  std::uint64_t least = limit_in(root / file);
  for (group = group.relative_path(); !group.empty(); group = group.parent_path()) {
    least = std::min(least, limit_in(root / group / file));
  }
  return least;
}

std::uint64_t control_group_memory() {
  std::uint64_t least = kNoLimit;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {  // number:controllers:path
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string path = line.substr(second + 1);
    if (controllers == ",,")
      least = std::min(least, least_limit("/sys/fs/cgroup", path, "memory.max"));
    if (controllers.find(",memory,") != std::string::npos) {
      least = std::min(least, least_limit("/sys/fs/cgroup/memory", path, "memory.limit_in_bytes"));
    }
  }
  return least;
}

}  // namespace

MemoryBudget::MemoryBudget() : limit_(machine_memory() / 2) {}

std::uint64_t MemoryBudget::left() const {
  const std::uint64_t resident = resident_set();
  return limit_ > resident ? limit_ - resident : 0;
}

void MemoryBudget::require(std::uint64_t bytes, const std::string& file,
                           const std::string& place) const {
  thread_local std::uint64_t small = 0;
  small += std::min(bytes, kWorthLooking);
  if (small < kWorthLooking) return;
  small = 0;
  std::uint64_t resident = resident_set();
  const auto fits = [&] { return resident <= limit_ && bytes <= limit_ - resident; };
  if (fits()) return;
  malloc_trim(0);  // what was freed and is kept for later
  resident = resident_set();
  if (fits()) return;
  throw FileError(Cause::memory, file, place,
                  "takes " + bytes_text(bytes) + " of memory; the program has " +
                      bytes_text(resident) + " and may have " + bytes_text(limit_) + " (--memory)");
}

std::uint64_t machine_memory() {
  static const std::uint64_t bytes = std::min(physical_memory(), control_group_memory());
  return bytes;
}

std::uint64_t resident_set() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  if (!(file >> all >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::string bytes_text(std::uint64_t bytes) {
  constexpr std::array kNames = {"KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  if (bytes < 1024) return std::to_string(bytes) + " bytes";
  auto amount = static_cast<double>(bytes) / 1024;
  std::size_t unit = 0;
  for (; amount >= 999.5 && unit + 1 < kNames.size(); ++unit) amount /= 1024;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f %s",
                amount < 9.995   ? 2
                : amount < 99.95 ? 1
                                 : 0,
                amount, kNames[unit]);
  return text.data();
}

std::uint64_t parse_bytes(std::string_view text) {
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

}  // namespace delray::files
