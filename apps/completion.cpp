// Writes completion scripts for bash, zsh and fish from the command line as plain data. A further
// shell is a function and an entry in kShells.
#include "apps/completion.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace delray::apps {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string result;
  for (const std::string& word : words) result += (result.empty() ? "" : " ") + word;
  return result;
}

// In single quotes, whatever it is.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::vector<std::string> names_below(const CommandText& command) {
  std::vector<std::string> names;
  for (const CommandText& below : command.commands) names.push_back(below.name);
  return names;
}

// Calls f(command, path) for the command and all below it; the path is what follows the program's
// name, "compare compose".
void for_each_command(const CommandText& command, const std::string& path,
                      const std::function<void(const CommandText&, const std::string&)>& f) {
  f(command, path);
  for (const CommandText& below : command.commands)
    for_each_command(below, path.empty() ? below.name : path + " " + below.name, f);
}

std::string bash(const CommandText& program) {
  std::string paths, values, words;
  for_each_command(program, "", [&](const CommandText& command, const std::string& path) {
    std::vector<std::string> options, next = names_below(command);
    for (const OptionText& option : command.options) {
      if (option.positional) {
        next.insert(next.end(), option.values.begin(), option.values.end());
        continue;
      }
      options.insert(options.end(), option.names.begin(), option.names.end());
      if (!option.takes_value) continue;
      const std::string offer =
          option.values.empty()
              ? "_files"
              : (option.files ? "_words_or_files " : "_words ") + quoted(joined(option.values));
      for (const std::string& name : option.names) {
        values += fmt::format("    {}) _delray{}; return ;;\n",
                              quoted(fmt::format("{}:{}", path, name)), offer);
      }
    }
    if (!path.empty()) paths += fmt::format("      {}) path=$next ;;\n", quoted(path));
    words += fmt::format("    {}) options={} words={} ;;\n", quoted(path), quoted(joined(options)),
                         quoted(joined(next)));
  });
  return fmt::format(R"(# Completion of delray in bash: source <(delray completion bash)
# One candidate a line, as names of files may have spaces.
_delray_words() {{ mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current"); }}
_delray_files() {{
  compopt -o filenames 2> /dev/null
  mapfile -t COMPREPLY < <(compgen -f -- "$current")
}}
_delray_words_or_files() {{
  compopt -o filenames 2> /dev/null
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current"; compgen -f -- "$current")
}}
_delray() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}}
  local path= next= word options= words=
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    next=${{path:+$path }}$word
    case $next in
{0}    esac
  done
  case "$path:$previous" in
{1}  esac
  case $path in
{2}  esac
  if [[ $current == -* ]]; then
    _delray_words "$options"
  elif [[ -n $words ]]; then
    _delray_words "$words"
  else
    _delray_files
  fi
}}
complete -F _delray delray
)",
                     paths, values, words);
}

std::string zsh(const CommandText& program) {
  // In an _arguments specification brackets and colons have a meaning.
  const auto plain = [](const std::string& text) {
    std::string result;
    for (const char c : text) {
      if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
      result += c;
    }
    return result;
  };
  std::string functions;
  for_each_command(program, "", [&](const CommandText& command, const std::string& path) {
    std::string name = "_delray";
    for (const char c : path.empty() ? "" : "_" + path) name += c == ' ' ? '_' : c;
    std::string arguments;
    for (const OptionText& option : command.options) {
      if (option.positional) continue;
      const std::string names = joined(option.values);
      const std::string value = !option.takes_value     ? ""
                                : option.values.empty() ? ":value:_files"
                                : option.files ? ":value:{compadd -- " + names + "; _files}"
                                               : ":value:(" + names + ")";
      for (const std::string& one : option.names) {
        arguments += fmt::format(
            " \\\n    {}", quoted(fmt::format("{}[{}]{}", one, plain(option.description), value)));
      }
    }
    if (command.commands.empty()) {
      functions +=
          fmt::format("{}() {{\n  _arguments -S{} \\\n    '*:file:_files'\n}}\n", name, arguments);
      return;
    }
    std::string below, cases;
    for (const CommandText& one : command.commands) {
      below += " " + quoted(plain(one.name) + ":" + one.description);
      cases += fmt::format("    {}) {}_{} ;;\n", one.name, name, one.name);
    }
    functions += fmt::format(R"({0}() {{
  local state line commands=({1})
  _arguments -C{2} \
    '1: :->command' '*:: :->rest'
  case $state in
    command) _describe command commands ;;
    rest) case $line[1] in
{3}    esac ;;
  esac
}}
)",
                             name, below, arguments, cases);
  });
  return "#compdef delray\n# Completion of delray in zsh: as _delray in a folder of $fpath\n" +
         functions + "_delray \"$@\"\n";
}

std::string fish(const CommandText& program) {
  std::string result =
      "# Completion of delray in fish: delray completion fish > "
      "~/.config/fish/completions/delray.fish\n";
  for_each_command(program, "", [&](const CommandText& command, const std::string& path) {
    std::string when;
    for (std::size_t begin = 0; begin < path.size();) {
      const std::size_t end = std::min(path.find(' ', begin), path.size());
      when += (when.empty() ? "" : "; and ") +
              fmt::format("__fish_seen_subcommand_from {}", path.substr(begin, end - begin));
      begin = end + 1;
    }
    const std::string below = joined(names_below(command));
    const std::string none_below =
        below.empty() ? "" : fmt::format("not __fish_seen_subcommand_from {}", below);
    const std::string here =
        when + (when.empty() || none_below.empty() ? "" : "; and ") + none_below;
    for (const CommandText& one : command.commands) {
      result += fmt::format("complete -c delray -n {} -f -a {} -d {}\n", quoted(here),
                            quoted(one.name), quoted(one.description));
    }
    for (const OptionText& option : command.options) {
      if (option.positional) continue;
      std::string line = fmt::format("complete -c delray -n {}", quoted(here));
      for (const std::string& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (option.takes_value && option.values.empty()) line += " -r";
      if (!option.values.empty())
        line += (option.files ? " -r -F -a " : " -x -a ") + quoted(joined(option.values));
      result += line + " -d " + quoted(option.description) + "\n";
    }
  });
  return result;
}

constexpr Shell kShells[] = {
    {"bash", "source <(delray completion bash)", bash},
    {"zsh", "delray completion zsh > ~/.zfunc/_delray  # in a folder of $fpath", zsh},
    {"fish", "delray completion fish > ~/.config/fish/completions/delray.fish", fish},
};

}  // namespace

std::span<const Shell> shells() { return kShells; }

}  // namespace delray::apps
