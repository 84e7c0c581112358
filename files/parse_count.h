// Counts as people write them: 1e6, 2.5e5, 10k, 1_000_000.
#pragma once

#include <cstdint>
#include <string_view>

namespace delray::files {

// The whole number that `text` stands for: decimal digits, "_" between digits, perhaps a point, an
// exponent (e6) or one of k (10^3), M (10^6) and G (10^9), K and g being the same. Exact. Throws
// std::invalid_argument for what is none, has a fraction ("2.5"), is negative or is above 2^64 - 1.
std::uint64_t parse_count(std::string_view text);

}  // namespace delray::files
