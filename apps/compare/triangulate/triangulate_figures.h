// The results of a comparison of triangulation methods, as JSON and as text.
#pragma once

#include "apps/compare/triangulate/compare_triangulate.h"
#include "apps/statistics.h"

namespace delray::apps {

// What statistics say of the points that are compared.
Json compared_input_json(const TriangulateRequest& request, std::size_t points, int dim);
// `delray.compare.triangulate/1`.
Json triangulate_statistics(const TriangulateRequest& request,
                            const TriangulateComparison& comparison);
// A heading and a line for each row.
TextTable triangulate_table(const TriangulateComparison& comparison);

}  // namespace delray::apps
