// Which points of an input are read: --class, --returns, --bounds and --resolution.
#pragma once

#include <string>

#include "delaunay/point_filter.h"

namespace CLI {
class App;
}

namespace delray::apps {

// As on the command line; empty and 0: all points.
struct PointChoice {
  std::string classes, returns, bounds;
  double resolution = 0;

  bool given() const {
    return !classes.empty() || !returns.empty() || !bounds.empty() || resolution > 0;
  }
};

void add_choice_options(CLI::App& command, PointChoice& choice);

// Throws UsageError for what is no list of classes or no box.
delaunay::PointFilter filter_of(const PointChoice& choice);

}  // namespace delray::apps
