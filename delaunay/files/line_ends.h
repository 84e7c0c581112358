// Line ends of texts from before Mac OS X.
#pragma once

#include <string>

#include "files/format.h"

namespace delray::delaunay {

// The content with "\n" for "\r" if its first line ends with "\r" alone. Of a binary PLY only the
// header is text; formats that are no text at all, or whose readers take either, stay as they are.
std::string with_line_feeds(files::Format format, std::string content);

}  // namespace delray::delaunay
