// The facts that it takes to run something again.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "apps/session.h"

namespace delray::apps {

// Processor and hardware threads of this machine.
std::string machine_text();
// And the compiler with its version, the kind of build and its flags.
std::string machine_and_compiler();

// Name and value: command line, version, machine, compiler, system, time.
std::vector<std::pair<std::string, std::string>> provenance(const Session& session);
// And what a generated scene was generated from.
std::vector<std::pair<std::string, std::string>> provenance(const Session& session,
                                                            const std::string& scene);

}  // namespace delray::apps
