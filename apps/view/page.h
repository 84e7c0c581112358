// The page: all of it in one text, which refers to nothing outside.
#pragma once

#include <string>

namespace delray::apps::view {

std::string page();

namespace internal {
extern const char* const kBody;        // HTML
extern const char* const kStyle;       // CSS
extern const char* const kCamera;      // JavaScript: orbit, pan, zoom, fly
extern const char* const kControls;    // mouse, touch, keys
extern const char* const kPanel;       // options, picks, figures
extern const char* const kConnection;  // frames and messages
}  // namespace internal

}  // namespace delray::apps::view
