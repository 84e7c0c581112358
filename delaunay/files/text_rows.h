// Texts of one row per line: found sequentially at the speed of memchr, then parsed in parallel.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <string_view>
#include <vector>

#include "delaunay/files/input.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {

// Says whether a line (without its end) is a row.
using IsRow = bool (*)(std::string_view line);

// Neither blank nor a comment: '#' or "//" first.
bool is_data_row(std::string_view line);

// Where a text stands: a byte, and the number (from 1) of the line that begins there.
struct TextPlace {
  std::size_t byte = 0, line = 1;
};

// Where rows are. Every kRowsPerBlock-th row has an entry in `blocks`.
struct RowIndex {
  static constexpr std::size_t kRowsPerBlock = 4096;  // about 0.5 ms of parsing
  std::vector<TextPlace> blocks;
  std::size_t count = 0;
  TextPlace end;  // after the last row that was counted
};

constexpr std::size_t kAllRows = std::numeric_limits<std::size_t>::max();

// Finds at most `limit` rows from `begin` on. O(bytes).
RowIndex index_rows(const Input& input, TextPlace begin, std::size_t limit, IsRow is_row);

// The line that begins at `place`; moves `place` behind it.
std::string_view take_line(std::string_view content, TextPlace& place);

enum class Separator { comma, semicolon };  // besides blanks and tabs, which always separate

// Takes the fields of one line from left to right.
class Fields {
 public:
  Fields(const Input& input, std::string_view line, std::size_t number,
         Separator separator = Separator::comma)
      : input_(&input),
        rest_(line),
        number_(number),
        separator_(separator == Separator::comma ? ',' : ';') {}

  // False at the end of the line or at a comment. A field between two commas may be empty.
  bool next(std::string_view& field);
  // The next field as a number; FileError if there is none or it is not a finite number.
  double number();
  // The next field as a whole number.
  std::int64_t integer();
  [[noreturn]] void fail(const std::string& what) const;
  std::size_t line_number() const { return number_; }

 private:
  std::string_view required();

  const Input* input_;
  std::string_view rest_;
  std::size_t number_;
  char separator_;
};

enum class NumberError { none, not_a_number, not_finite };
// The double nearest to the decimal number that `text` is, and nothing else. Too small is 0.
NumberError parse_number(std::string_view text, double& value);
bool parse_integer(std::string_view text, std::int64_t& value);

// Calls f(row, Fields&) for each row, rows from 0, in parallel. Of several errors that of the first
// line is thrown.
template <class F>
void for_each_row(const Input& input, const RowIndex& index, IsRow is_row, F&& f,
                  Separator separator = Separator::comma) {
  std::vector<std::exception_ptr> errors(index.blocks.size());
  parallel::parallel_for(0, index.blocks.size(), 1, [&](std::size_t block) {
    TextPlace place = index.blocks[block];
    std::size_t row = block * RowIndex::kRowsPerBlock;
    const std::size_t last = std::min(index.count, row + RowIndex::kRowsPerBlock);
    try {
      while (row < last) {
        const std::size_t number = place.line;
        const std::string_view line = take_line(input.content, place);
        if (!is_row(line)) continue;
        Fields fields(input, line, number, separator);
        f(row++, fields);
      }
    } catch (const files::FileError&) {
      errors[block] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace delray::delaunay
