// Finds the fewest ranks that are about as fast as any, and compares their busiest rank's time with
// that of the next number of ranks. Degenerate: the last number of ranks has nothing to compare
// with.
#include "apps/compare/scaling_limit.h"

#include <fmt/format.h>

#include <algorithm>

namespace delray::apps {

ScalingLimit limit_of(std::span<const ScaledFrame> frames, double alone) {
  const auto least = std::min_element(
      frames.begin(), frames.end(),
      [](const ScaledFrame& a, const ScaledFrame& b) { return a.seconds < b.seconds; });
  const auto here = std::find_if(frames.begin(), frames.end(), [&](const ScaledFrame& frame) {
    return frame.seconds <= kWorthwhile * least->seconds;
  });
  ScalingLimit limit;
  limit.here = *here;
  limit.ranks = here->ranks;
  limit.seconds = here->seconds;
  limit.speed_up = alone / here->seconds;
  limit.efficiency = limit.speed_up / here->ranks;
  const auto next = here + 1;
  if (next == frames.end()) return limit;
  limit.next = *next;
  std::size_t most = 0;
  const auto growth = [&](std::size_t i) { return next->parts[i] - here->parts[i]; };
  for (std::size_t i = 1; i < here->parts.size(); ++i)
    if (growth(i) > growth(most)) most = i;
  limit.grows = most;
  return limit;
}

Json limit_json(const ScalingLimit& limit, std::span<const char* const> parts) {
  Json one = {{"ranks", limit.ranks},
              {"seconds", limit.seconds},
              {"speed_up", limit.speed_up},
              {"efficiency", limit.efficiency}};
  one["grows"] = limit.grows ? Json(parts[*limit.grows]) : Json(nullptr);
  if (!limit.grows) return one;
  one["next"] = {{"ranks", limit.next.ranks}, {"seconds", limit.next.seconds}};
  one["grows_from"] = limit.here.parts[*limit.grows];
  one["grows_to"] = limit.next.parts[*limit.grows];
  return one;
}

std::vector<report::Column> limit_columns() {
  constexpr auto kPredicted = report::Source::predicted;
  return {{"stops gaining at", true, true, kPredicted},
          {"ms", true, true, kPredicted},
          {"speed-up", true, true, kPredicted},
          {"efficiency", true, true, kPredicted},
          {"with", true, false, {}},
          {"ms there", true, true, kPredicted},
          {"what grows", false, true, kPredicted},
          {"from ms", true, true, kPredicted},
          {"to ms", true, true, kPredicted}};
}

std::vector<std::string> limit_cells(const ScalingLimit& limit,
                                     std::span<const char* const> parts) {
  const auto milliseconds = [](double seconds) { return fmt::format("{:.4g}", seconds * 1e3); };
  std::vector<std::string> cells = {std::to_string(limit.ranks), milliseconds(limit.seconds),
                                    fmt::format("{:.3g}", limit.speed_up),
                                    fmt::format("{:.2g}", limit.efficiency)};
  std::vector<std::string> rest(5, "-");
  if (limit.grows) {
    rest = {std::to_string(limit.next.ranks), milliseconds(limit.next.seconds), parts[*limit.grows],
            milliseconds(limit.here.parts[*limit.grows]),
            milliseconds(limit.next.parts[*limit.grows])};
  }
  cells.insert(cells.end(), rest.begin(), rest.end());
  return cells;
}

}  // namespace delray::apps
