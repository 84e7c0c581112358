// Sorting numbers by their upper halves.
#pragma once

#include <cstdint>

#include "delaunay/mesh/array.h"
#include "delaunay/mesh/blocks.h"

namespace delray::delaunay::internal {

// Sorts by bits 32 to 63 and keeps the order of entries that have them in common: least significant
// digit first, every block counting and moving its own entries (Zagha and Blelloch 1991). O(n),
// with a second array of n entries. REQUIRES: blocks of entries.size() indices.
void radix_sort(Array<std::uint64_t>& entries, const Blocks& blocks);

}  // namespace delray::delaunay::internal
