// What every report looks like and does in the browser.
#pragma once

namespace delray::apps::report::internal {

extern const char* const kStyle;   // CSS
extern const char* const kScript;  // JavaScript

}  // namespace delray::apps::report::internal
