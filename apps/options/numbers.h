// Which numbers options take. CLI11's own checks let pass what is no number (NaN), which is neither
// too small nor too large.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

namespace delray::apps {

CLI::Validator positive_number();      // above 0, finite
CLI::Validator positive_float();       // the same as a float: neither 0 nor infinite then
CLI::Validator non_negative_number();  // 0 or more, finite
CLI::Validator number_between(double least, double most);

// A whole number, also as 1e6, 2.5e5, 10k or 1_000_000 (files/parse_count.h), which it rewrites as
// digits: for Option::transform.
CLI::Validator count_between(std::uint64_t least, std::uint64_t most);
CLI::Validator any_count();
// The side of a block of pixels, 1 to 4096, or `cache`, which it rewrites as the side of one whose
// colours and depths fit this processor's first-level data cache (loadbalance/cache_block.h).
CLI::Validator block_side();

}  // namespace delray::apps
