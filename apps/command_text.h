// The command line as plain data, for whatever is made of the help texts.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace delray::apps {

struct OptionText {
  std::vector<std::string> names;  // "-o", "--output"; of a positional its name alone
  std::string description;
  bool positional = false;
  bool takes_value = false;
  std::vector<std::string> values;  // names to choose from; empty where anything goes
};

struct CommandText {
  std::string name, description;
  std::vector<std::string> examples;  // whole command lines
  std::vector<OptionText> options;
  std::vector<CommandText> commands;
};

// Of the command and all below it.
CommandText command_text(CLI::App& command);

}  // namespace delray::apps
