// Tables of text, for terminals and logs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace delray::apps {

// A heading, then lines of as many texts.
using TextTable = std::vector<std::vector<std::string>>;

// The table with columns two blanks apart, numbers aligned to the right. Where its lines are longer
// than `width` it is several tables, one below the other, with some of the columns each; all begin
// with the first columns that tell the lines apart. O(size of the table).
//
// REQUIRES: a heading; as many texts in every line.
std::string aligned(const TextTable& table, std::size_t width);

}  // namespace delray::apps
