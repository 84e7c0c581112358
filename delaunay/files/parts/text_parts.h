// Text of points in parts: ranges of bytes, each with the lines that begin in it.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>

#include "delaunay/files/parts/byte_source.h"
#include "delaunay/files/parts/file_parts.h"
#include "delaunay/files/text_rows.h"

namespace delray::delaunay {

// The lines of a text that begin in byte ranges of equal size.
class LineRanges {
 public:
  static constexpr std::uint64_t kUsual = std::uint64_t{1} << 21;  // some 6 ms of parsing

  // Lines from byte `begin` on, where one begins, which is the line of that number.
  //
  // REQUIRES: range_bytes >= 1.
  LineRanges(ByteSource source, TextPlace begin, std::uint64_t range_bytes = kUsual)
      : source_(std::move(source)), begin_(begin), range_bytes_(range_bytes) {}

  const ByteSource& source() const { return source_; }
  std::size_t ranges() const {
    return static_cast<std::size_t>((source_.size() - begin_.byte + range_bytes_ - 1) /
                                    range_bytes_);
  }
  std::uint64_t bytes(std::size_t range) const { return end_of(range) - begin_of(range); }
  // How many lines begin in the range: reads it.
  std::uint64_t lines(std::size_t range) const;
  // The lines that begin in the range, whole, in `buffer` or in the source's memory.
  std::string_view read(std::size_t range, std::string& buffer) const;
  // The number of the first line that begins in the range: reads all before it, for messages.
  std::size_t first_line(std::size_t range) const;

 private:
  std::uint64_t begin_of(std::size_t range) const { return begin_.byte + range * range_bytes_; }
  std::uint64_t end_of(std::size_t range) const {
    return std::min(source_.size(), begin_of(range) + range_bytes_);
  }

  ByteSource source_;
  TextPlace begin_;
  std::uint64_t range_bytes_;
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
