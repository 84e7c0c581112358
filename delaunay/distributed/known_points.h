// Points of whole areas that a rank knows, and the search among them for the third corner of a
// Delaunay triangle over an edge.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "delaunay/construction/apex_search.h"
#include "delaunay/tiles.h"

namespace delray::delaunay {

class KnownPoints {
 public:
  bool has(int area) const { return areas_.contains(area); }
  // Points of an area that is not known yet, each once. O(n log n).
  void add(int area, std::vector<RowPoint> points);

  // The point to the left of the edge whose circle through a and b has no known point inside;
  // nothing if there is none to the left. By the rule of predicates/conflict.h. O(log n) expected
  // where points are spread evenly.
  std::optional<RowPoint> apex_of(const RowPoint& a, const RowPoint& b) const;

 private:
  struct Area {
    std::vector<RowPoint> points;
    ApexSearch<2> search;  // its points are these, in the same order
  };

  std::map<int, Area> areas_;
};

}  // namespace delray::delaunay
