// Looking up an entry of a table by its name.
#pragma once

#include <algorithm>
#include <span>
#include <string_view>

namespace delray::files {

// The entry of `table` whose `name` is `name`, the first of several; null if there is none.
// O(entries).
template <class Entry>
const Entry* find_named(std::span<const Entry> table, std::string_view name) {
  const auto at =
      std::ranges::find_if(table, [name](const Entry& entry) { return entry.name == name; });
  return at == table.end() ? nullptr : &*at;
}

}  // namespace delray::files
