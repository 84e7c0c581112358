// How the simplices that threads made lie together.
#pragma once

#include <cstdint>
#include <span>

#include "delaunay/triangulation.h"

namespace delray::delaunay {

// Connected sets of simplices that one thread made (Kohout 2004, 7.9): at best as many as there are
// threads. makers[i] is the thread that made simplex i (Options::makers). 0 for no simplices. O(n)
// expected.
//
// REQUIRES: a maker for each simplex; vertices are below `rows`.
std::uint64_t count_fragments(const Triangulation& triangulation,
                              std::span<const std::uint16_t> makers, std::size_t rows);

}  // namespace delray::delaunay
