// The program `delray`.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "apps/commands.h"
#include "apps/launch.h"

namespace {

using namespace delray::apps;

// Progress, warnings and errors go to stderr: stdout is for results.
void set_up_log() {
  const bool colour = std::getenv("NO_COLOR") == nullptr;
  auto log = spdlog::stderr_color_mt(
      "delray", colour ? spdlog::color_mode::automatic : spdlog::color_mode::never);
  log->set_pattern("%^%l%$: %v");
  spdlog::set_default_logger(std::move(log));
}

std::string joined(int argc, char** argv) {
  std::string line;
  for (int i = 0; i < argc; ++i) line += (i ? " " : "") + std::string(argv[i]);
  return line;
}

int run(int argc, char** argv) {
  set_up_log();
  Session session;
  session.command_line = joined(argc, argv);
  find_launcher(session);

  CLI::App program("Delray renders scenes in parallel and triangulates points in parallel.",
                   "delray");
  program.set_version_flag("--version", "delray " DELRAY_VERSION);
  program.require_subcommand(1);
  add_info(program, session);
  add_generate(program, session);
  add_triangulate(program, session);
  add_verify(program, session);
  add_render(program, session);
  add_compose(program, session);
  add_compare(program, session);
  add_completion(program, session);
  add_manual(program, session);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (!session.first_process) return kDone;
    return program.exit(error) == 0 ? kDone : kUsage;
  }
  return run_guarded(session);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {  // before a subcommand began
    std::fprintf(stderr, "error: %s\n", error.what());
    return kFailed;
  }
}
