// Speed-ups of triangulation methods beside what formulas say of them.
#pragma once

#include "apps/compare/triangulate/triangulate_rows.h"
#include "apps/report/html.h"

namespace delray::apps {

// A line for each of `rows` with several threads whose method is in `all` with one: speed-up,
// efficiency, the sequential fraction (Karp and Flatt), and the most that Amdahl's law allows.
// Empty without such rows.
report::Html scaling_laws(const ComparedTriangulations& all, const ComparedTriangulations& rows);

}  // namespace delray::apps
