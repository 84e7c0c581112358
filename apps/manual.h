// The help texts as a man page.
#pragma once

#include <string>

#include "apps/options/command_text.h"

namespace delray::apps {

// For man(7), section 1.
std::string manual(const CommandText& program, const std::string& version);

}  // namespace delray::apps
