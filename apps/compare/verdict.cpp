// Sentences and cells about what takes least.
#include "apps/compare/verdict.h"

#include <fmt/format.h>

namespace delray::apps {

std::string time_text(double seconds) {
  return seconds < 1 ? fmt::format("{:.3g} ms", seconds * 1e3) : fmt::format("{:.3g} s", seconds);
}

std::string measured_text(const Spread& seconds) {
  if (seconds.runs <= 1) return time_text(seconds.median) + " (measured once)";
  return fmt::format("{} (measured, median of {} runs, {} to {})", time_text(seconds.median),
                     seconds.runs, time_text(seconds.low), time_text(seconds.high));
}

std::string milliseconds_cell(const Spread& seconds) {
  if (seconds.runs <= 1) return fmt::format("{:.3g} (once)", seconds.median * 1e3);
  return fmt::format("{:.3g} ({:.3g} to {:.3g})", seconds.median * 1e3, seconds.low * 1e3,
                     seconds.high * 1e3);
}

std::string listed(std::span<const std::string> names, std::size_t most) {
  const std::size_t named = names.size() <= most + 1 ? names.size() : most;
  if (named < names.size())
    return fmt::format("{} and {} more", fmt::join(names.first(named), ", "), names.size() - named);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::string winners_cell(std::span<const std::string> names) {
  constexpr const char* kEqual = " \u2248 ";
  if (names.empty()) return "-";
  if (names.size() <= 2) return fmt::format("{}", fmt::join(names, kEqual));
  return fmt::format("{}{}{} more", names[0], kEqual, names.size() - 1);
}

}  // namespace delray::apps
