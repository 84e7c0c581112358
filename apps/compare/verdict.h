// Sentences of reports on what takes least: with its spread, and beside what cannot be told from
// it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/compare/spread.h"

namespace delray::apps {

// "3.1 ms", "2.04 s".
std::string time_text(double seconds);
// "3.1 ms (measured, median of 9 runs, 2.9 ms to 3.3 ms)", or "3.1 ms (measured once)".
std::string measured_text(const Spread& seconds);
// "0.0529 (0.0511 to 0.06)", in milliseconds, for tables; the interval is that of differ().
std::string milliseconds_cell(const Spread& seconds);

// "a", "a and b", "a, b and c", "a, b, c and 3 more": at most `most` by name, unless one is left.
std::string listed(std::span<const std::string> names, std::size_t most = 4);
// The names that cannot be told apart, for tables, which say what the mark means: "a", "a \u2248
// b", "a \u2248 3 more".
std::string winners_cell(std::span<const std::string> names);

// The row that takes least and all that cannot be told from it, as least_of() orders them.
template <class Row, class SpreadOf>
std::vector<const Row*> winners(std::span<const Row* const> rows, SpreadOf&& spread_of_row) {
  std::vector<Spread> spreads;
  for (const Row* row : rows) spreads.push_back(spread_of_row(*row));
  std::vector<const Row*> result;
  for (const std::size_t i : least_of(spreads)) result.push_back(rows[i]);
  return result;
}

}  // namespace delray::apps
