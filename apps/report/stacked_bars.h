// Bars of parts, one below the other.
#pragma once

#include <string>
#include <vector>

#include "apps/report/html.h"

namespace delray::apps::report {

struct StackedBar {
  std::string name;
  std::vector<double> parts;  // one for each kind, >= 0
};

struct StackedBars {
  std::string title;
  std::string unit;  // of the parts
  Source source = Source::measured;
  bool shares = false;             // every bar has the same length: parts of a hundred
  std::vector<std::string> kinds;  // at most 8
  std::vector<StackedBar> bars;
};

// A figure with one bar below the other, from 0; amounts and shares on hover.
Html stacked_bars(const StackedBars& chart);

}  // namespace delray::apps::report
