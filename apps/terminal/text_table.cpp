// Tables of text: columns are measured, divided among tables that fit, and printed.
#include "apps/terminal/text_table.h"

#include <algorithm>
#include <set>

namespace delray::apps {
namespace {

constexpr std::size_t kGap = 2;  // blanks between columns

struct TextColumn {
  std::size_t width = 0;
  bool has_numbers = true;
};

bool is_number(const std::string& text) {
  return text.empty() || text == "-" || (text[0] >= '0' && text[0] <= '9');
}

std::vector<TextColumn> measure(const TextTable& table) {
  std::vector<TextColumn> columns(table[0].size());
  for (std::size_t k = 0; k < table.size(); ++k) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      columns[i].width = std::max(columns[i].width, table[k][i].size());
      if (k > 0 && !is_number(table[k][i])) columns[i].has_numbers = false;
    }
  }
  return columns;
}

// The number of first columns that tell all lines apart; one if all together do not.
std::size_t key_columns(const TextTable& table) {
  for (std::size_t keys = 1; keys < table[0].size(); ++keys) {
    std::set<std::vector<std::string>> seen;
    const bool apart = std::all_of(table.begin() + 1, table.end(), [&](const auto& line) {
      return seen.insert({line.begin(), line.begin() + static_cast<std::ptrdiff_t>(keys)}).second;
    });
    if (apart) return keys;
  }
  return 1;
}

// The columns of each table, by number, those that all begin with first.
std::vector<std::vector<std::size_t>> divide(const TextTable& table,
                                             const std::vector<TextColumn>& columns,
                                             std::size_t width) {
  std::vector<std::size_t> keys;
  std::size_t key_width = 0;
  for (std::size_t i = 0; i < key_columns(table); ++i) {
    keys.push_back(i);
    key_width += columns[i].width + kGap;
  }
  std::vector<std::vector<std::size_t>> tables(1, keys);
  std::size_t used = key_width;
  for (std::size_t i = keys.size(); i < columns.size(); ++i) {
    const bool fits = used <= width && columns[i].width <= width - used;
    if (!fits && tables.back().size() > keys.size()) {
      tables.push_back(keys);
      used = key_width;
    }
    tables.back().push_back(i);
    used += columns[i].width + kGap;
  }
  return tables;
}

std::string line_text(const std::vector<std::string>& line, const std::vector<TextColumn>& columns,
                      const std::vector<std::size_t>& shown) {
  std::string text;
  for (const std::size_t i : shown) {
    const std::string blanks(columns[i].width - line[i].size(), ' ');
    if (i != shown.front()) text.append(kGap, ' ');
    text += columns[i].has_numbers ? blanks + line[i] : line[i] + blanks;
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text + "\n";
}

}  // namespace

std::string aligned(const TextTable& table, std::size_t width) {
  const std::vector<TextColumn> columns = measure(table);
  std::string text;
  for (const std::vector<std::size_t>& shown : divide(table, columns, width)) {
    if (!text.empty()) text += "\n";
    for (const std::vector<std::string>& line : table) text += line_text(line, columns, shown);
  }
  return text;
}

}  // namespace delray::apps
