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
  std::string description, heading;
  std::string placeholder;  // of its value: "FILE", "N,..."
  std::string range;        // of numbers: "1 to 64"; empty where anything goes
  bool positional = false;
  bool takes_value = false;
  bool takes_several = false;
  std::vector<std::string> values;  // names to choose from; empty where anything goes
  bool files = false;               // or, besides, any file
};

// "-o, --output"
std::string names_text(const OptionText& option);
// The description, with the names to choose from where it does not tell them itself, and the range.
std::string full_description(const OptionText& option);

struct CommandText {
  std::string name, description;
  std::vector<std::string> examples;  // whole command lines
  std::vector<OptionText> options;
  std::vector<CommandText> commands;
};

// Applies to the command and all below it.
CommandText command_text(const CLI::App& command);

}  // namespace delray::apps
