// The option --background.
#pragma once

#include <string>
#include <vector>

#include "shading/background.h"

namespace delray::apps {

using shading::Background;

// The names that parse_background takes, besides colours.
std::vector<std::string> background_names();

// "auto", "environment", "studio", "transparent", or "#rrggbb" in sRGB. Throws UsageError.
Background parse_background(const std::string& text);

}  // namespace delray::apps
