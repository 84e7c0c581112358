// Tables of names: --list prints them, options choose from them.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/session.h"

namespace delray::apps {

// For --list: an entry a line, name, tab, description.
template <class Table>
void print_table(const Table& table) {
  for (const auto& entry : table) fmt::print("{}\t{}\n", entry.name, entry.description);
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

}  // namespace delray::apps
