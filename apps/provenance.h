// What it takes to run something again.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "apps/session.h"

namespace delray::apps {

// Name and value: command line, version, machine, libraries, time.
std::vector<std::pair<std::string, std::string>> provenance(const Session& session);
// And what a generated scene was generated from.
std::vector<std::pair<std::string, std::string>> provenance(const Session& session,
                                                            const std::string& scene);

}  // namespace delray::apps
