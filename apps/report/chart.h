// Charts as inline SVG, with the numbers on hover.
#pragma once

#include <string>
#include <vector>

#include "apps/report/axis.h"
#include "apps/report/html.h"

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
  int look = -1;                   // its colour and dash, from 0; -1: by its place among the series
};

struct LineChart {
  std::string title;
  std::string x_label, y_label;  // with units
  Scale x_scale = Scale::linear, y_scale = Scale::linear;
  bool ticks_at_points = false;  // of the x axis, where there are few
  std::vector<Series> series;
};

// A figure; its legend turns series off and on. A logarithmic axis leaves out what is not above 0.
// O(points).
Html line_chart(const LineChart& chart);

struct Bar {
  std::string name;
  double value = 0;
  std::string note;  // on hover, after the value
  bool emphasised = false;
};

struct BarChart {
  std::string title;
  std::string label;  // of the values, with units
  Source source = Source::counted;
  std::vector<Bar> bars;
  double mark = 0;  // a line across all bars, e.g. their mean; 0: none
  double name_width = 190;
};

// A figure with one bar below the other, from 0.
Html bar_chart(const BarChart& chart);

}  // namespace delray::apps::report
