// Lines and words of a text in memory, without copies.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <type_traits>

#include "files/decimal.h"

namespace delray::scenes::internal {

// The words of one line, separated by blanks.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  // Empty when there are no more.
  std::string_view next() {
    std::size_t begin = 0;
    while (begin < rest_.size() && is_blank(rest_[begin])) ++begin;
    std::size_t end = begin;
    while (end < rest_.size() && !is_blank(rest_[end])) ++end;
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }
  // All that is left, without the blanks around it.
  std::string_view rest() const {
    std::string_view rest = rest_;
    while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
    while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
    return rest;
  }

 private:
  static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
  }
  std::string_view rest_;
};

class Lines {
 public:
  // `before`: the number of lines before the text, where it is a part of one.
  explicit Lines(std::string_view text, std::uint64_t before = 0) : text_(text), number_(before) {}

  // The next line without its end ("\n", "\r\n" or "\r"); false after the last.
  bool next(std::string_view& line) {
    if (at_ == text_.size()) return false;
    // Looked for once, however many "\r" come before.
    if (line_feed_ < at_ || at_ == 0) line_feed_ = std::min(text_.find('\n', at_), text_.size());
    const std::string_view rest = text_.substr(at_, line_feed_ - at_);
    line = rest.substr(0, rest.find('\r'));
    std::size_t end = at_ + line.size();
    if (end < line_feed_ && end + 1 == line_feed_ && line_feed_ < text_.size()) ++end;
    at_ = std::min(text_.size(), end + 1);
    ++number_;
    return true;
  }
  // The next line that has words once a comment, from `mark` on, is cut off.
  bool next_with_words(std::string_view& line, char mark) {
    while (next(line)) {
      line = line.substr(0, line.find(mark));
      if (!Words(line).next().empty()) return true;
    }
    return false;
  }

  std::uint64_t number() const { return number_; }  // of the line last returned, from 1
  std::string place() const { return "line " + std::to_string(number_); }

 private:
  std::string_view text_;
  std::size_t at_ = 0, line_feed_ = 0;  // where the next line and the next "\n" are
  std::uint64_t number_ = 0;
};

// The whole word as a number; false if it is none. A leading '+' is allowed. A real number too
// large for its type is infinite, one too small is 0; a whole number that does not fit is none.
template <class T>
bool parse(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  if constexpr (std::is_same_v<T, double>) {
    const char* const last = word.data() + word.size();
    if (files::read_short_decimal(word.data(), last, value) == last) return !word.empty();
  }
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return false;
  if constexpr (std::is_floating_point_v<T>) {
    if (error == std::errc::result_out_of_range) {
      value = static_cast<T>(std::strtod(std::string(word).c_str(), nullptr));
      return true;
    }
  }
  return error == std::errc{};
}

}  // namespace delray::scenes::internal
