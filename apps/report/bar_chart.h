// Bars, one below the other.
#pragma once

#include <string>
#include <vector>

#include "apps/report/html.h"

namespace delray::apps::report {

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
};

// A figure with one bar below the other, from 0.
Html bar_chart(const BarChart& chart);

}  // namespace delray::apps::report
