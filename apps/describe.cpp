// delray completion and delray manual: what is made of the help texts.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "apps/commands.h"
#include "apps/completion.h"
#include "apps/manual.h"
#include "apps/options/list.h"

namespace delray::apps {

void add_completion(CLI::App& program, Session& session) {
  CLI::App* command = program.add_subcommand(
      "completion", "Print a script that completes command lines in a shell");
  const auto name = std::make_shared<std::string>();
  std::vector<std::string> names;
  for (const Shell& shell : shells()) names.emplace_back(shell.name);
  command->add_option("SHELL", *name, "Shell that the script is for")
      ->check(one_of(names))
      ->required();
  std::string footer = "Examples:\n";
  for (const Shell& shell : shells()) footer += fmt::format("  {}\n", shell.description);
  command->footer(footer);
  command->callback([&session, &program, name] {
    session.run = [&program, name] {
      fmt::print("{}", find_entry(shells(), *name, "SHELL").completion(command_text(program)));
      return kDone;
    };
  });
}

void add_manual(CLI::App& program, Session& session) {
  CLI::App* command = program.add_subcommand("manual", "Print the manual as a man page");
  command->footer("Examples:\n  delray manual | man -l -\n  delray manual > delray.1\n");
  command->callback([&session, &program] {
    session.run = [&program] {
      fmt::print("{}", manual(command_text(program), DELRAY_VERSION));
      return kDone;
    };
  });
}

}  // namespace delray::apps
