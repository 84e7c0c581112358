// Lines and words of a text in memory, without copies.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <type_traits>

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
  explicit Lines(std::string_view text) : rest_(text) {}

  // The next line without its end ("\n", "\r\n" or "\r"); false after the last.
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line = rest_.substr(0, end);
    const bool pair = end + 1 < rest_.size() && rest_[end] == '\r' && rest_[end + 1] == '\n';
    rest_.remove_prefix(std::min(rest_.size(), end + (pair ? 2 : 1)));
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
  std::string_view rest_;
  std::uint64_t number_ = 0;
};

// The whole word as a number; false if it is none. A leading '+' is allowed. A real number too
// large for its type is infinite, one too small is 0; a whole number that does not fit is none.
template <class T>
bool parse(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
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
