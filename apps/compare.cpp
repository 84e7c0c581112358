// delray compare: variants of one thing on an input of the user's own.
#include <CLI/CLI.hpp>

#include "apps/commands.h"
#include "apps/compare/compare_commands.h"

namespace delray::apps {

void add_compare(CLI::App& program, Session& session) {
  CLI::App* command = program.add_subcommand(
      "compare", "Compare algorithms on an input of your own: counted, measured and predicted");
  command->require_subcommand(1);
  add_compare_compose(*command, session);
  add_compare_triangulate(*command, session);
  add_compare_partition(*command, session);
  add_compare_schedule(*command, session);
}

}  // namespace delray::apps
