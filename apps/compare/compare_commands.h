// The subcommands of `delray compare`: each adds itself and, when chosen, sets session.run.
#pragma once

#include "apps/session.h"

namespace delray::apps {

void add_compare_compose(CLI::App& compare, Session& session);
void add_compare_triangulate(CLI::App& compare, Session& session);
void add_compare_partition(CLI::App& compare, Session& session);
void add_compare_schedule(CLI::App& compare, Session& session);

}  // namespace delray::apps
