// What the ways to triangulate have in common: statistics and messages.
#pragma once

#include <cstdint>

#include "apps/statistics.h"
#include "apps/triangulate/triangulate_options.h"
#include "delaunay/triangulate.h"

namespace delray::apps {

struct Seconds {
  double read = 0, triangulate = 0;
};

// What statistics say however a triangulation was made.
Json statistics_of(const TriangulateOptions& options, std::size_t points,
                   const delaunay::Triangulation& result, std::uint64_t simplices,
                   const delaunay::Hash128& hash, const Seconds& seconds);

void add_phases(const delaunay::Statistics& phases, Json& statistics);

// That the method left no choice.
void tell_no_choices(Json& statistics);

// Of a raster.
void add_output(const Json& output, Json& statistics);

void warn_of_no_simplices(const TriangulateOptions& options, std::uint64_t simplices);

void tell_result(int dim, std::size_t rows, std::uint64_t distinct, std::uint64_t simplices,
                 double seconds);

}  // namespace delray::apps
