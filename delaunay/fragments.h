// Connected parts of a triangulation that were made by one thread each.
#pragma once

#include <cstdint>
#include <span>

#include "delaunay/triangulation.h"

namespace delray::delaunay {

// Connected sets of simplices that one thread made (Kohout 2004, 7.9): at best as many as there are
// threads. created_by[i] is the thread that made simplex i (Result::created_by). 0 for no
// simplices. O(n) expected.
//
// REQUIRES: a creator for each simplex; vertices are below `rows`.
std::uint64_t count_fragments(const Triangulation& triangulation,
                              std::span<const std::uint16_t> created_by, std::size_t rows);

}  // namespace delray::delaunay
