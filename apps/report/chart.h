// Charts as inline SVG, with the numbers on hover.
#pragma once

#include <string>
#include <vector>

#include "apps/report/axis.h"
#include "apps/report/html.h"
#include "apps/report/look.h"

namespace delray::apps::report {

// One point of a line; `low` and `high` are the spread of repetitions, equal to y where there is
// none.
struct ChartPoint {
  double x = 0, y = 0;
  double low = y, high = y;
};

struct Series {
  std::string name;
  Source source = Source::measured;
  std::vector<ChartPoint> points;  // by ascending x; those that are not finite are left out
  Look look = {};
};

struct LineChart {
  std::string title;
  std::string x_label, y_label;  // with units
  Scale x_scale = Scale::linear, y_scale = Scale::linear;
  bool ticks_at_points = false;  // of the x axis, where there are few
  bool more_is_better = false;   // of y
  std::vector<Series> series;
};

// So many lines are all drawn in colour.
inline constexpr std::size_t kMostStrong = 5;

// The series that are drawn in colour and named at their ends: all of a few; of more, of each
// group the one that is best at most of the chart's x. O(points^2).
std::vector<bool> strong_series(const LineChart& chart);

// A figure. Lines that are not strong are grey until they, their name in the legend or a line of
// the same name in another chart are pointed at or chosen. A logarithmic axis leaves out what is
// not above 0. O(points^2).
Html line_chart(const LineChart& chart);

// A chart with logarithmic axes and ticks where there are points: of what depends on ranks, threads
// or points.
Html logarithmic_chart(const std::string& title, const std::string& x_label,
                       const std::string& y_label, std::vector<Series> series);

}  // namespace delray::apps::report
