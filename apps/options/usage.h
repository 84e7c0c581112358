// Errors of a command line that CLI11 refused, in one line.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace delray::apps {

// The first command or option among `arguments` that the program does not have, with the one that
// was probably meant; or that a command is missing. Empty if there is neither.
std::string unknown_name(const CLI::App& program, const std::vector<std::string>& arguments);

// The message for `error`, with the --help that tells more.
std::string usage_message(const CLI::App& program, const std::vector<std::string>& arguments,
                          const CLI::ParseError& error);

// The command that the arguments lead to, however much of them is understood: the last one of
// "delray compare compose".
const CLI::App& command_of(const CLI::App& program, const std::vector<std::string>& arguments);

}  // namespace delray::apps
