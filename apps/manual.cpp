// Writes the command line as roff: one section for each command, with its options and examples.
#include "apps/manual.h"

#include <fmt/format.h>

#include <algorithm>

namespace delray::apps {
namespace {

// As text: no escapes, no requests at the beginning of a line.
std::string plain(const std::string& text) {
  std::string result = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text) {
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else if (c == '\n')
      result += ' ';
    else
      result += c;
  }
  return result;
}

std::string option_entry(const OptionText& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += (names.empty() ? "" : ", ") + fmt::format("\\fB{}\\fR", plain(name));
  if (!option.positional && option.takes_value)
    names += fmt::format(" \\fI{}\\fR", plain(option.placeholder));
  return fmt::format(".TP\n{}\n{}\n", names, plain(full_description(option)));
}

std::string section(const CommandText& command, const std::string& path) {
  std::string result = fmt::format(".SS delray {}\n{}\n", plain(path), plain(command.description));
  for (const OptionText& option : command.options) result += option_entry(option);
  if (!command.examples.empty()) {
    result += ".PP\nExamples:\n.nf\n";
    for (const std::string& example : command.examples) result += plain(example) + "\n";
    result += ".fi\n";
  }
  for (const CommandText& below : command.commands)
    result += section(below, path + " " + below.name);
  return result;
}

}  // namespace

std::string manual(const CommandText& program, const std::string& version) {
  std::string result = fmt::format(
      ".TH DELRAY 1 \"\" \"delray {}\" \"User Commands\"\n"
      ".SH NAME\ndelray \\- render scenes in parallel and triangulate points in parallel\n"
      ".SH SYNOPSIS\n.B delray\n\\fICOMMAND\\fR [\\fIOPTION\\fR]...\n"
      ".SH DESCRIPTION\n{}\n.SH OPTIONS\n",
      plain(version), plain(program.description));
  for (const OptionText& option : program.options) result += option_entry(option);
  result += ".SH COMMANDS\n";
  for (const CommandText& command : program.commands) result += section(command, command.name);
  return result +
         ".SH EXIT STATUS\n"
         ".TP\n0\ndone\n"
         ".TP\n1\nsomething failed while running: a full disk, a device, no more memory\n"
         ".TP\n2\nwrong usage\n"
         ".TP\n3\na file is not what it should be\n"
         ".TP\n4\nverification failed\n"
         ".TP\n5\na rank was lost or timed out\n"
         ".TP\n130\ninterrupted\n";
}

}  // namespace delray::apps
