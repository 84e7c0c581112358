// Partitions: the frame cut into regions with owners.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "geometry/rect.h"
#include "loadbalance/costs.h"

namespace delray::loadbalance {

struct Region {
  geometry::Rect rect;
  int owner = 0;
};

// Disjoint regions that cover the frame exactly once; an owner may have several or none.
struct Partition {
  geometry::Rect frame;
  std::vector<Region> regions;
};

struct Partitioner {
  const char* name;
  const char* description;
  // Owners are 0 .. parts-1. REQUIRES: parts >= 1; frame == costs.frame.
  Partition (*partition)(const Costs& costs, geometry::Rect frame, int parts);
};

// The table: --list, tests, benchmarks and reports iterate over it.
std::span<const Partitioner> partitioners();
const Partitioner* find_partitioner(std::string_view name);  // nullptr when there is none

// The cost of each owner's regions, from the cells: a cell cut by a border counts by area, one
// without pixels not at all. Size: owners. REQUIRES: partition.frame == costs.frame.
std::vector<double> loads(const Costs& costs, const Partition& partition, int owners);

}  // namespace delray::loadbalance
