// Text made safe for pages, and numbers as people read them.
#pragma once

#include <string>
#include <string_view>

namespace delray::apps::report {

// HTML of a page's body. What makes it escapes the text that it is given.
using Html = std::string;

// With <, >, & and " replaced, for text and for attributes in double quotes.
Html escaped(std::string_view text);

// The source of a number, which is shown wherever the number is.
enum class Source { counted, measured, predicted };
std::string_view name_of(Source source);

// "<strong>text</strong>", escaped.
Html strong(std::string_view text);

// Four significant digits, with k, M, G from 10 000 on: 0.05312, 17.3, 2048, 1.234 M.
std::string short_number(double value);

}  // namespace delray::apps::report
