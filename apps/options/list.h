// Tables of names: --list prints them, options choose from them.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/session.h"

namespace delray::apps {

struct NameAndDescription {
  std::string name, description;
};

// For --list: an entry a line, name, tab, description; on a terminal columns under `heading`.
void print_list(const std::string& heading, const std::vector<NameAndDescription>& entries);
// The list as text, for a terminal of so many columns.
std::string list_text(const std::string& heading, const std::vector<NameAndDescription>& entries,
                      std::size_t width);

template <class Table>
void print_table(const std::string& heading, const Table& table) {
  std::vector<NameAndDescription> entries;
  for (const auto& entry : table) {
    entries.push_back({std::string(entry.name), std::string(entry.description)});
  }
  print_list(heading, entries);
}

template <class Table>
std::vector<std::string> names_in(const Table& table) {
  std::vector<std::string> names;
  for (const auto& entry : table) names.emplace_back(entry.name);
  return names;
}

// "'sort-frist' is not one of sort-first, sort-last; did you mean 'sort-first'?".
std::string is_not_one_of(std::string_view name, const std::vector<std::string>& names);

// The entry called `name`. Throws UsageError that names the legal ones.
template <class Table>
const auto& find_entry(const Table& table, std::string_view name, std::string_view option) {
  for (const auto& entry : table) {
    if (entry.name == name) return entry;
  }
  throw UsageError(fmt::format("{}: {}", option, is_not_one_of(name, names_in(table))));
}

// Checks that an option's value is one of `names`.
CLI::Validator one_of(const std::vector<std::string>& names);

// Values that an option takes besides names.
struct OtherValues {
  static constexpr const char* kFile = "FILE";  // the shape of names of files
  std::string shape;                            // for messages: "#rrggbb"
  bool (*fit)(const std::string& value) = nullptr;
};

// Checks that the values of an option of the command, which has been added, are names or others.
void choose_from(CLI::App& command, const std::string& option,
                 const std::vector<std::string>& names, const OtherValues& others = {});

// The names that one_of or choose_from lets the option's values be; empty where anything goes.
std::vector<std::string> choices(const CLI::Option& option);
// Whether they may be files as well.
bool takes_files(const CLI::Option& option);

}  // namespace delray::apps
