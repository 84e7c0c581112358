// Text in parts: ranges of bytes, each with the lines that begin in it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/file_bytes.h"

namespace delray::files {

// The lines of a text that begin in byte ranges of equal size. Lines end with "\n"; a text of other
// line ends is one range.
class LineRanges {
 public:
  static constexpr std::uint64_t kUsual = std::uint64_t{1} << 21;  // some 6 ms of parsing

  // Lines from byte `begin` on, where one begins. With `continued` a line end behind that character
  // ends no line. Reads as much of each range as it takes to find its first line: no more than the
  // text in all.
  //
  // REQUIRES: range_bytes >= 1; begin <= bytes.size().
  LineRanges(const FileBytes& bytes, std::uint64_t begin, std::uint64_t range_bytes = kUsual,
             char continued = '\0');

  std::size_t ranges() const { return starts_.size() - 1; }
  std::uint64_t begin(std::size_t range) const { return starts_[range]; }
  std::uint64_t bytes(std::size_t range) const { return starts_[range + 1] - starts_[range]; }
  // How many lines begin in the range: reads it.
  std::uint64_t lines(std::size_t range) const;
  // The lines that begin in the range, whole, in `buffer` or in memory.
  std::string_view read(std::size_t range, std::string& buffer) const {
    return bytes_.read(starts_[range], bytes(range), buffer);
  }

 private:
  FileBytes bytes_;
  std::vector<std::uint64_t> starts_;  // of the first lines, and the end of the text
};

}  // namespace delray::files
