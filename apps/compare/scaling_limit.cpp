// Finds the fewest ranks that are about as fast as any, and compares their busiest rank's time with
// that of the next number of ranks. Degenerate: the last number of ranks has nothing to compare
// with.
#include "apps/compare/scaling_limit.h"

#include <fmt/format.h>

#include <algorithm>

#include "parallel/speed_up.h"

namespace delray::apps {

std::vector<report::Column> speed_up_columns(report::Source source) {
  return {{"speed-up", true, true, source},
          {"efficiency", true, true, source},
          {"sequential", true, true, source}};
}

std::vector<std::string> speed_up_cells(double speed_up, int ranks) {
  return {
      fmt::format("{:.2f}", speed_up), fmt::format("{:.3f}", parallel::efficiency(speed_up, ranks)),
      ranks > 1 && speed_up > 0 ? fmt::format("{:.4f}", parallel::serial_fraction(speed_up, ranks))
                                : std::string("-")};
}

Json serial_fraction_json(double speed_up, int ranks) {
  if (ranks <= 1 || !(speed_up > 0)) return nullptr;
  return parallel::serial_fraction(speed_up, ranks);
}

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
  limit.speed_up = parallel::speed_up(alone, here->seconds);
  limit.efficiency = parallel::efficiency(limit.speed_up, here->ranks);
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
              {"efficiency", limit.efficiency},
              {"serial_fraction", serial_fraction_json(limit.speed_up, limit.ranks)}};
  one["grows"] = limit.grows ? Json(parts[*limit.grows]) : Json(nullptr);
  if (!limit.grows) return one;
  one["next"] = {{"ranks", limit.next.ranks}, {"seconds", limit.next.seconds}};
  one["scalability"] = parallel::scalability(limit.seconds, limit.next.seconds);
  one["grows_from"] = limit.here.parts[*limit.grows];
  one["grows_to"] = limit.next.parts[*limit.grows];
  return one;
}

std::vector<report::Column> limit_columns() {
  constexpr auto kPredicted = report::Source::predicted;
  std::vector<report::Column> columns = {{"stops gaining at", true, true, kPredicted},
                                         {"ms", true, true, kPredicted}};
  for (report::Column& column : speed_up_columns(kPredicted)) columns.push_back(std::move(column));
  for (report::Column column : {report::Column{"with", true, false, {}},
                                {"ms there", true, true, kPredicted},
                                {"scalability", true, true, kPredicted},
                                {"what grows", false, true, kPredicted},
                                {"from ms", true, true, kPredicted},
                                {"to ms", true, true, kPredicted}})
    columns.push_back(std::move(column));
  return columns;
}

std::vector<std::string> limit_cells(const ScalingLimit& limit,
                                     std::span<const char* const> parts) {
  const auto milliseconds = [](double seconds) { return fmt::format("{:.4g}", seconds * 1e3); };
  std::vector<std::string> cells = {std::to_string(limit.ranks), milliseconds(limit.seconds)};
  for (std::string& cell : speed_up_cells(limit.speed_up, limit.ranks))
    cells.push_back(std::move(cell));
  std::vector<std::string> rest(6, "-");
  if (limit.grows) {
    rest = {std::to_string(limit.next.ranks),
            milliseconds(limit.next.seconds),
            fmt::format("{:.3g}", parallel::scalability(limit.seconds, limit.next.seconds)),
            parts[*limit.grows],
            milliseconds(limit.here.parts[*limit.grows]),
            milliseconds(limit.next.parts[*limit.grows])};
  }
  cells.insert(cells.end(), rest.begin(), rest.end());
  return cells;
}

}  // namespace delray::apps
