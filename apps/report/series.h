// Lines of a chart from rows of results.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "apps/report/chart.h"

namespace delray::apps::report {

// The values of `of` for the rows, each once, in order of appearance.
template <class Rows, class F>
auto unique_of(const Rows& rows, F&& of) {
  std::vector<std::decay_t<decltype(of(*rows.begin()))>> result;
  for (const auto& row : rows)
    if (std::find(result.begin(), result.end(), of(row)) == result.end()) result.push_back(of(row));
  return result;
}

// A line for each name, of the points that its rows have: point(row) is an optional<ChartPoint>,
// look(name) a Look. REQUIRES: the rows of a name come by ascending x.
template <class Rows, class Name, class Look, class Point>
std::vector<Series> series_by(const Rows& rows, Name&& name, Look&& look, Source source,
                              Point&& point) {
  std::vector<Series> result;
  for (const auto& one : unique_of(rows, name)) {
    Series series{std::string(one), source, {}, look(one)};
    for (const auto& row : rows) {
      if (name(row) == one)
        if (const std::optional<ChartPoint> at = point(row)) series.points.push_back(*at);
    }
    if (!series.points.empty()) result.push_back(std::move(series));
  }
  return result;
}

}  // namespace delray::apps::report
