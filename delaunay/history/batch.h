// The batch method: threads that locate and one that inserts.
#pragma once

#include <cstddef>

#include "delaunay/points.h"
#include "delaunay/triangulate.h"

namespace delray::delaunay::internal {

// Threads, options.searching of them or as many as measured times ask for, locate points in the
// shared history and put what they found into a bounded queue; one thread takes it out, goes on to
// the leaf, subdivides and legalizes (Kohout 2004, 7.5). A single thread does the one after the
// other.
//
// REQUIRES: resolved options. Errors: see triangulate().
Result insert_in_batches(PointView<double> points, const Options& options);

// The report's best length of the queue for so many points (Figure 7.6).
std::size_t default_queue(std::size_t points);

}  // namespace delray::delaunay::internal
