// A line belongs to the range that it begins in. Whoever looks for the first line of a range begins
// one byte before it, to see whether a line begins with it. A range that lies within a line is
// empty: the line belongs to one before.
#include "files/line_ranges.h"

#include <algorithm>

namespace delray::files {
namespace {

constexpr std::uint64_t kNoLine = ~std::uint64_t{0};
constexpr std::uint64_t kFirstLook = 4096;  // bytes; as a rule there is a line end among them

// Whether the line end at `at` of `text` ends a line. Where that cannot be seen it is taken not to.
bool ends_line(std::string_view text, std::size_t at, char continued) {
  if (continued == '\0') return true;
  while (at > 0 && text[at - 1] == '\r') --at;
  return at > 0 && text[at - 1] != continued;
}

// The first byte of the first line that begins in [begin, end), or `end`.
std::uint64_t first_line_start(const FileBytes& bytes, std::uint64_t begin, std::uint64_t end,
                               char continued) {
  std::string buffer;
  std::uint64_t at = begin - 1;
  for (std::uint64_t look = kFirstLook; at < end - 1; look *= 8) {
    const std::string_view text = bytes.read(at, std::min(look, end - 1 - at), buffer);
    for (std::size_t i = text.find('\n'); i != text.npos; i = text.find('\n', i + 1)) {
      if (ends_line(text, i, continued)) return at + i + 1;
    }
    at += text.size();
  }
  return end;
}

}  // namespace

LineRanges::LineRanges(const FileBytes& bytes, std::uint64_t begin, std::uint64_t range_bytes,
                       char continued)
    : bytes_(bytes) {
  const std::uint64_t size = bytes.size(), ranges = (size - begin + range_bytes - 1) / range_bytes;
  starts_ = {begin};
  for (std::uint64_t range = 1; range < ranges; ++range) {
    const std::uint64_t first = begin + range * range_bytes;
    const std::uint64_t end = std::min(size, first + range_bytes);
    const std::uint64_t start = first_line_start(bytes, first, end, continued);
    starts_.push_back(start == end ? kNoLine : start);
  }
  starts_.push_back(size);
  for (std::size_t i = starts_.size() - 1; i-- > 0;) {
    if (starts_[i] == kNoLine) starts_[i] = starts_[i + 1];
  }
  if (ranges == 0) starts_ = {begin};
}

std::uint64_t LineRanges::lines(std::size_t range) const {
  std::string buffer;
  const std::string_view text = read(range, buffer);
  const auto ends = static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
  return ends + (!text.empty() && text.back() != '\n' ? 1 : 0);
}

}  // namespace delray::files
