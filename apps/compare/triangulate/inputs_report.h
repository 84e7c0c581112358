// Comparisons of triangulation methods on several inputs, each by itself.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "apps/compare/triangulate/compare_distributed.h"
#include "apps/compare/triangulate/compare_triangulate.h"
#include "apps/report/page.h"
#include "apps/session.h"
#include "apps/statistics.h"

namespace delray::apps {

struct ComparedInput {
  TriangulateRequest request;  // of this input alone
  TriangulateComparison comparison;
  DistributedComparison simulated;  // ranks of the methods for these, if any
};

// All of the following REQUIRE at least one input; with one they are those of a single comparison.
//
// A line for each row, with the input where there are several.
TextTable inputs_table(std::span<const ComparedInput> inputs);
// Statistics of the first, and under "inputs" those of all where there are several.
Json inputs_statistics(std::span<const ComparedInput> inputs);
// The page of the first, before which, where there are several, a tab has the speed-up and the
// efficiency of each method on all of them (Kohout 2004, Figures 7.23 and 7.24).
report::Page inputs_page(const Session& session, std::span<const ComparedInput> inputs);

}  // namespace delray::apps
