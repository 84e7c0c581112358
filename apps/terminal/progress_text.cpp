// The text of a progress bar.
#include "apps/terminal/progress_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace delray::apps {
namespace {

constexpr int kBarWidth = 30;
constexpr double kLeastShare = 0.01, kLeastSeconds = 1;  // to estimate from

std::string duration_text(double seconds) {
  constexpr double kMinute = 60, kHour = 3600;
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  if (seconds < 100 * kMinute) return fmt::format("{:.0f} min", seconds / kMinute);
  return fmt::format("{:.0f} h", seconds / kHour);
}

std::string whole_text(const std::string& what, const TaskState& state) {
  if (state.total == 0)
    return fmt::format("{}: {}  {}", what, state.done, duration_text(state.seconds));
  const double share =
      std::min(1.0, static_cast<double>(state.done) / static_cast<double>(state.total));
  const int full = static_cast<int>(share * kBarWidth);
  std::string text = fmt::format("{}: [{:#<{}}{:.<{}}] {:3.0f} %", what, "", full, "",
                                 kBarWidth - full, 100 * share);
  const bool is_known = share >= kLeastShare && state.seconds >= kLeastSeconds;
  if (is_known) text += "  " + duration_text(state.seconds * (1 - share) / share) + " left";
  return text;
}

}  // namespace

std::string progress_text(const std::string& what, const TaskState& state, std::size_t width) {
  return whole_text(what, state).substr(0, width);
}

}  // namespace delray::apps
