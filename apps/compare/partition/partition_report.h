// The comparison of partitions as a page.
#pragma once

#include <string>

#include "apps/compare/partition/compare_partition.h"
#include "apps/session.h"

namespace delray::apps {

std::string partition_report(const Session& session, const PartitionRequest& request,
                             const Prepared& prepared, const PartitionComparison& comparison);

}  // namespace delray::apps
