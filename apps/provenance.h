// What it takes to run something again.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "apps/session.h"

namespace delray::apps {

// Name and value: command line, version, machine, libraries, time.
std::vector<std::pair<std::string, std::string>> provenance(const Session& session);

}  // namespace delray::apps
