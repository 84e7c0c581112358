// The subcommands: each adds itself to the command line and, when chosen, sets session.run.
#pragma once

#include "apps/session.h"

namespace delray::apps {

void add_info(CLI::App& program, Session& session);
void add_generate(CLI::App& program, Session& session);
void add_triangulate(CLI::App& program, Session& session);
void add_verify(CLI::App& program, Session& session);
void add_render(CLI::App& program, Session& session);
void add_view(CLI::App& program, Session& session);
void add_pack(CLI::App& program, Session& session);
void add_compose(CLI::App& program, Session& session);
void add_compare(CLI::App& program, Session& session);
void add_replay(CLI::App& program, Session& session);
void add_similar(CLI::App& program, Session& session);
// These tell of all the others.
void add_completion(CLI::App& program, Session& session);
void add_manual(CLI::App& program, Session& session);

}  // namespace delray::apps
