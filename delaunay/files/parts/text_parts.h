// Text of points in parts: ranges of bytes, each with the lines that begin in it.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "delaunay/files/parts/byte_source.h"
#include "delaunay/files/parts/file_parts.h"
#include "delaunay/files/text_rows.h"
#include "files/line_ranges.h"

namespace delray::delaunay {

// The lines of a text that begin in byte ranges of equal size, with their numbers.
class LineRanges : public files::LineRanges {
 public:
  // Lines from `begin` on, where one begins, which is the line of that number.
  LineRanges(ByteSource source, TextPlace begin, std::uint64_t range_bytes = kUsual)
      : files::LineRanges(source, begin.byte, range_bytes),
        source_(std::move(source)),
        first_line_(begin.line) {}

  const ByteSource& source() const { return source_; }
  // The number of the first line that begins in the range: reads all before it, for messages.
  std::size_t first_line(std::size_t range) const;

 private:
  ByteSource source_;
  std::size_t first_line_;
};

// Calls f(Fields&) for each row of a range, in order; of a FileError that it throws, the line
// number is right although nobody counts lines otherwise: then all is read once more.
template <class F>
void for_each_row(const LineRanges& lines, std::size_t range, Separator separator, F&& f) {
  std::string buffer;
  const std::string_view text = lines.read(range, buffer);
  const Input input = lines.source().input(text);
  const auto go = [&](std::size_t first_line) {
    TextPlace place{0, first_line};
    while (place.byte < text.size()) {
      const std::size_t number = place.line;
      const std::string_view line = take_line(text, place);
      if (!is_data_row(line)) continue;
      Fields fields(input, line, number, separator);
      f(fields);
    }
  };
  try {
    go(1);
  } catch (const files::FileError&) {
    go(lines.first_line(range));
    throw;
  }
}

// Null for what has to be looked at whole: line ends of "\r" alone, a first row of counts that the
// rows confirm, nothing but comments in the first megabyte. Throws FileError.
std::unique_ptr<FileParts> open_text_parts(const ByteSource& source,
                                           std::uint64_t range_bytes = LineRanges::kUsual);

}  // namespace delray::delaunay
