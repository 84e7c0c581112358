// Partitions: the frame cut into regions with owners.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "geometry/rect.h"
#include "loadbalance/costs.h"

namespace delray::loadbalance {

// A rectangle of the frame and its owner. An owner's part of the frame is all regions with its
// number: it need not be a rectangle, nor in one piece.
struct Region {
  geometry::Rect rect;
  int owner = 0;
  bool operator==(const Region&) const = default;
};

// Disjoint regions that cover the frame exactly once; an owner may have several or none.
struct Partition {
  geometry::Rect frame;
  std::vector<Region> regions;
};

// An entry of the table of partitions.
struct Partitioner {
  const char* name;
  const char* description;
  // Owners are 0 .. parts-1. Those that look at boxes take the cells for boxes where there are
  // none. Throws std::invalid_argument unless parts >= 1, frame == costs.frame, and every cost is
  // finite and >= 0.
  Partition (*partition)(const Costs& costs, geometry::Rect frame, int parts);
  const char* group;  // of partitions that work alike; reports show these in one colour
};

// The table: --list, tests, benchmarks and reports iterate over it.
std::span<const Partitioner> partitioners();
const Partitioner* find_partitioner(std::string_view name);  // nullptr when there is none

// The cost of each owner's regions, from the cells: a cell cut by a border counts by area, one
// without pixels not at all. Size: owners. Throws std::invalid_argument unless frames are equal and
// owners of regions below `owners`.
std::vector<double> loads(const Costs& costs, const Partition& partition, int owners);

// The largest of the loads over their mean, predicted or measured; 1 where all are 0.
double imbalance(std::span<const double> loads);

// More regions than ranks, which comes out more even than one for each (Pixel-Planes 5: Fuchs et
// al. 1989): takes the owners of `regions` for the regions to be shared out and gives them, the
// one with the highest load first, to the rank with the lowest; ties go to the lowest number. The
// result's owners are 0 .. ranks-1. O(owners (log owners + log ranks) + loads).
// Throws std::invalid_argument unless ranks >= 1 and regions.frame == costs.frame.
Partition assign_largest_first(const Costs& costs, const Partition& regions, int ranks);

// Cuts into regions_per_rank * ranks regions, at least one each, and assigns those.
Partition partition_for_ranks(const Partitioner& partitioner, const Costs& costs, int ranks,
                              int regions_per_rank);

}  // namespace delray::loadbalance
