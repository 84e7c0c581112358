// The style sheet and the script of every report.
#pragma once

namespace delray::apps::report::internal {

extern const char* const kStyle;   // CSS
extern const char* const kScript;  // JavaScript
extern const char* const kMarks;   // SVG of what stands at points, ids m0, m1, ...

}  // namespace delray::apps::report::internal
