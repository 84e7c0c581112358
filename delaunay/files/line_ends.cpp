// Each "\r" of the text becomes "\n" if the first line ends with "\r" alone; linear in the text.
#include "delaunay/files/line_ends.h"

#include <algorithm>

namespace delray::delaunay {
namespace {

using files::Format;

// Length of the part of the content that is text, in bytes.
std::size_t text_size(Format format, const std::string& content) {
  constexpr std::string_view kEnd = "end_header";
  switch (format) {
    case Format::text:
    case Format::obj:
    case Format::off:
    case Format::node:
    case Format::poly:
      return content.size();
    case Format::ply: {
      const std::size_t end = content.find(kEnd);
      if (end == std::string::npos) return content.size();
      const bool ascii = content.substr(0, end).find("format ascii") != std::string::npos;
      return ascii ? content.size() : std::min(end + kEnd.size() + 1, content.size());
    }
    default:
      return 0;
  }
}

}  // namespace

std::string with_line_feeds(Format format, std::string content) {
  const std::size_t size = text_size(format, content);
  const std::size_t first = content.find_first_of("\r\n");
  if (first >= size || content[first] != '\r') return content;
  if (first + 1 < content.size() && content[first + 1] == '\n') return content;
  std::replace(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(size), '\r', '\n');
  return content;
}

}  // namespace delray::delaunay
