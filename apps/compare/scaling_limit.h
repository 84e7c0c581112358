// Where more ranks stop paying, and which part of the busiest rank's time is to blame.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/report/table.h"
#include "apps/statistics.h"

namespace delray::apps {

// A frame by so many ranks; what its busiest rank spends time on, in an order of the caller's.
struct ScaledFrame {
  int ranks = 0;
  double seconds = 0;
  std::vector<double> parts;
};

// The fewest ranks that no others outdo by more than kWorthwhile.
struct ScalingLimit {
  int ranks = 0;
  double seconds = 0;
  double speed_up = 1, efficiency = 1;  // over one rank
  // The part that grows most from there to the next number of ranks that was compared; none where
  // that was the last, and more ranks may still pay.
  std::optional<std::size_t> grows;
  ScaledFrame here, next;
};
inline constexpr double kWorthwhile = 1.05;

// `alone`: seconds of one rank. REQUIRES: there are frames, by ascending ranks, with equally many
// parts.
ScalingLimit limit_of(std::span<const ScaledFrame> frames, double alone);

// `parts` are the names of the parts.
Json limit_json(const ScalingLimit& limit, std::span<const char* const> parts);
// Speed-up, efficiency, and the fraction that Amdahl's law takes for sequential
// (parallel::serial_fraction), a dash for one rank: three cells and the columns over them.
std::vector<report::Column> speed_up_columns(report::Source source);
std::vector<std::string> speed_up_cells(double speed_up, int ranks);
// The last as JSON: null for one rank.
Json serial_fraction_json(double speed_up, int ranks);

// For tables: what limit_cells() gives, after columns of the caller's.
std::vector<report::Column> limit_columns();
// Ranks, milliseconds, speed-up, efficiency, sequential fraction; then the next number of ranks,
// its milliseconds, what it gains (parallel::scalability), the part that grows, and from what to
// what. Dashes where there is no next.
std::vector<std::string> limit_cells(const ScalingLimit& limit, std::span<const char* const> parts);

}  // namespace delray::apps
