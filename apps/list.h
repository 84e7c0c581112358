// --list: the entries of a family's table, one per line: name, tab, description.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "apps/session.h"

namespace delray::apps {

// "kind:" headings are not printed: a line is an entry.
template <class Table>
void print_table(const Table& table) {
  for (const auto& entry : table) fmt::print("{}\t{}\n", entry.name, entry.description);
}

// The entry called `name`. Throws UsageError that names the legal ones.
template <class Table>
const auto& find_entry(const Table& table, std::string_view name, std::string_view option) {
  std::string legal;
  for (const auto& entry : table) {
    if (entry.name == name) return entry;
    legal += (legal.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw UsageError(fmt::format("{}: '{}' is not one of {}", option, name, legal));
}

}  // namespace delray::apps
