// Queries of the rows of a comparison of triangulations, which its page needs again and again.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/compare/triangulate/compare_triangulate.h"

namespace delray::apps {

using ComparedTriangulations = std::vector<ComparedTriangulation>;

// Numbers of points, each once, as they come.
std::vector<std::size_t> sizes_of(const ComparedTriangulations& rows);
// The most points for which there are three quarters of the rows that there are for the fewest:
// others were not finished, or left out as too slow. REQUIRES:
// !rows.empty().
std::size_t most_points(const ComparedTriangulations& rows);
ComparedTriangulations rows_of(const ComparedTriangulations& rows,
                               const std::function<bool(const ComparedTriangulation&)>& wanted);
// The row with the same method, location and number of points, with one thread; null without one.
const ComparedTriangulation* base_of(const ComparedTriangulations& rows,
                                     const ComparedTriangulation& row);
// Whether its method has one thread whatever it is told.
bool is_alone(const ComparedTriangulation& row);

// As texts: "2 threads", "triangles".
std::string threads_text(int count);
const char* simplices_text(int dim);
// A sentence on threads that share cores; empty where none do.
std::string crowded_text(const TriangulateComparison& comparison);

}  // namespace delray::apps
