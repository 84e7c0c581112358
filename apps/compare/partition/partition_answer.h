// The first screen of the page that compares partitions: which to take, and why.
#pragma once

#include <string_view>
#include <vector>

#include "apps/compare/partition/compare_partition.h"
#include "apps/report/html.h"

namespace delray::apps {

// REQUIRES: !comparison.rows.empty().
report::Html partition_answer(const PartitionComparison& comparison);

// Rows with so many regions for each rank.
std::vector<ComparedPartition> with_regions(const std::vector<ComparedPartition>& rows,
                                            int regions);
// Null if nothing is predicted over the network.
const PredictedFrame* prediction(const DrawnFrames& drawn, std::string_view network);

}  // namespace delray::apps
