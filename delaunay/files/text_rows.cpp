// Finds lines by memchr and converts fields by std::from_chars. Unlike from_chars alone it accepts
// a plus sign and reads numbers too small for a double as 0.
#include "delaunay/files/text_rows.h"

#include <charconv>
#include <cmath>
#include <cstring>

namespace delray::delaunay {
namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view without_blanks_before(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  return text;
}

// from_chars knows no plus sign.
std::string_view without_plus(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  return text;
}

// A field as it may appear in a message: short and printable.
std::string quoted(std::string_view field) {
  constexpr std::size_t kLongest = 40;
  std::string result = "\"";
  for (const char c : field.substr(0, kLongest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (field.size() > kLongest ? "...\"" : "\"");
}

// from_chars calls numbers too large and too small alike "out of range". A decimal number that is
// out of range is far from 1, so the power of ten of its first digit tells which.
bool is_too_small(std::string_view text) {
  const std::size_t exponent_mark = text.find_first_of("eE");
  long exponent = 0;
  if (exponent_mark != std::string_view::npos) {
    std::string_view digits = text.substr(exponent_mark + 1);
    const bool negative = digits.starts_with('-');
    if (negative || digits.starts_with('+')) digits.remove_prefix(1);
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    if (parsed.ec != std::errc()) return negative;
    if (negative) exponent = -exponent;
  }
  const std::string_view mantissa = text.substr(0, exponent_mark);
  const auto point = static_cast<long>(std::min(mantissa.find('.'), mantissa.size()));
  const auto first = static_cast<long>(mantissa.find_first_of("123456789"));
  return exponent + point - first < 0;
}

}  // namespace

bool is_data_row(std::string_view line) {
  line = without_blanks_before(line);
  return !line.empty() && line.front() != '#' && !line.starts_with("//");
}

std::string_view take_line(std::string_view content, TextPlace& place) {
  const char* begin = content.data() + place.byte;
  const std::size_t left = content.size() - place.byte;
  const void* end = left == 0 ? nullptr : std::memchr(begin, '\n', left);
  const std::size_t length =
      end ? static_cast<std::size_t>(static_cast<const char*>(end) - begin) : left;
  place.byte += length + (end ? 1 : 0);
  ++place.line;
  return {begin, length};
}

RowIndex index_rows(const Input& input, TextPlace begin, std::size_t limit, IsRow is_row) {
  RowIndex index;
  TextPlace place = begin;
  index.end = begin;
  while (index.count < limit && place.byte < input.content.size()) {
    const TextPlace start = place;
    if (!is_row(take_line(input.content, place))) continue;
    if (index.count % RowIndex::kRowsPerBlock == 0) index.blocks.push_back(start);
    ++index.count;
    index.end = place;
  }
  return index;
}

bool Fields::next(std::string_view& field) {
  rest_ = without_blanks_before(rest_);
  if (rest_.empty() || rest_.front() == '#') return false;
  std::size_t end = 0;
  while (end < rest_.size() && !is_blank(rest_[end]) && rest_[end] != separator_) ++end;
  field = rest_.substr(0, end);
  rest_ = without_blanks_before(rest_.substr(end));
  if (!rest_.empty() && rest_.front() == separator_) rest_.remove_prefix(1);
  return true;
}

std::string_view Fields::required() {
  std::string_view field;
  if (!next(field)) fail("the line ends too early");
  return field;
}

double Fields::number() {
  const std::string_view field = required();
  double value = 0;
  const NumberError error = parse_number(field, value);
  if (error == NumberError::not_a_number) fail("not a number: " + quoted(field));
  if (error == NumberError::not_finite) fail("not a finite number: " + quoted(field));
  return value;
}

std::int64_t Fields::integer() {
  const std::string_view field = required();
  std::int64_t value = 0;
  if (!parse_integer(field, value)) fail("not a whole number: " + quoted(field));
  return value;
}

void Fields::fail(const std::string& what) const {
  delray::delaunay::fail(*input_, at_line(number_), what);
}

NumberError parse_number(std::string_view text, double& value) {
  text = without_plus(text);
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (parsed.ec == std::errc::invalid_argument || parsed.ptr != end) {
    return NumberError::not_a_number;
  }
  if (parsed.ec == std::errc::result_out_of_range) {
    if (!is_too_small(text)) return NumberError::not_finite;
    value = 0;
  }
  return std::isfinite(value) ? NumberError::none : NumberError::not_finite;
}

bool parse_integer(std::string_view text, std::int64_t& value) {
  text = without_plus(text);
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

}  // namespace delray::delaunay
