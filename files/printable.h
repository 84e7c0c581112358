// Text from files, for terminals.
#pragma once

#include <string>
#include <string_view>

namespace delray::files {

// `text` without what a terminal would obey: control characters, and those that change the
// direction of writing, become escapes such as \n, \x1b and \u202e; bytes that are not UTF-8 become
// \xff and the like. All other text stays as it is.
std::string printable(std::string_view text);

}  // namespace delray::files
