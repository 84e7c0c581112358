// Which numbers options take. CLI11's own checks let pass what is no number (NaN), which is neither
// too small nor too large.
#pragma once

#include <CLI/CLI.hpp>

namespace delray::apps {

CLI::Validator positive_number();      // above 0, finite
CLI::Validator non_negative_number();  // 0 or more, finite
CLI::Validator number_between(double least, double most);

}  // namespace delray::apps
