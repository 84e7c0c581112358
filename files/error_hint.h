// What a user can do about an error, told behind it.
#pragma once

#include <algorithm>
#include <string>

#include "files/error.h"

namespace delray::files {

// The same error with "; " and a hint behind its text.
inline FileError with_hint(const FileError& error, const std::string& hint) {
  const std::string text = error.what();  // begins with the file and the place
  const std::size_t place = error.place().empty() ? 0 : error.place().size() + 2;
  const std::size_t begin = std::min(text.size(), error.file().size() + 2 + place);
  return {error.cause(), error.file(), error.place(), text.substr(begin) + "; " + hint};
}

}  // namespace delray::files
