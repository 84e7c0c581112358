// The size of the terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace delray::apps {

inline constexpr std::size_t kUnlimited = static_cast<std::size_t>(-1);

// Characters that fit into a line of the terminal that is `stream` (STDOUT_FILENO): as it says,
// else COLUMNS, else 80. Unlimited where it is no terminal.
std::size_t line_width(int stream);

// `text` in lines of at most `width` characters, cut at blanks; a word that is longer has a line of
// its own. At least one line.
std::vector<std::string> wrapped(std::string_view text, std::size_t width);

}  // namespace delray::apps
