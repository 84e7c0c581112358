// The colour and dash of a variant in all charts of all reports.
#pragma once

#include <string>

namespace delray::apps::report {

inline constexpr int kLookColours = 8, kLookMarks = 6, kLookDashes = 3;

// Variants of a group share a colour and differ by the marks at their points; what is derived from
// a variant by a parameter differs from it by the dashes of its line.
struct Look {
  int colour = -1;    // from 0, taken modulo kLookColours; -1: by the place among a chart's series
  int mark = 0;       // from 0, taken modulo kLookMarks
  int dash = 0;       // 0: a whole line; others are taken modulo kLookDashes
  std::string group;  // empty: a group of its own
};

}  // namespace delray::apps::report
