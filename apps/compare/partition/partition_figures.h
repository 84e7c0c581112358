// The results of a comparison of partitions, as JSON and as text.
#pragma once

#include "apps/compare/partition/compare_partition.h"

namespace delray::apps {

// `delray.compare.partition/1`.
Json partition_statistics(const PartitionRequest& request, const Prepared& prepared,
                          const PartitionComparison& comparison);
// A heading and a line for each row.
TextTable partition_table(const std::vector<ComparedPartition>& rows);

}  // namespace delray::apps
