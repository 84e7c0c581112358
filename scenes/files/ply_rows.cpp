// Text has a row on each line that has words; binary values follow each other without gaps.
#include "scenes/files/ply_rows.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace delray::scenes::internal {
namespace {

template <class T>
double decoded(const char* data, bool swap) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), data, sizeof(T));
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return static_cast<double>(std::bit_cast<T>(bytes));
}

}  // namespace

bool PlyFile::swap() const {
  return (header.coding == PlyCoding::big) == (std::endian::native == std::endian::little);
}

double ply_value(const char* data, PlyType type, bool swap) {
  switch (type) {
    case PlyType::i8:
      return decoded<std::int8_t>(data, swap);
    case PlyType::u8:
      return decoded<std::uint8_t>(data, swap);
    case PlyType::i16:
      return decoded<std::int16_t>(data, swap);
    case PlyType::u16:
      return decoded<std::uint16_t>(data, swap);
    case PlyType::i32:
      return decoded<std::int32_t>(data, swap);
    case PlyType::u32:
      return decoded<std::uint32_t>(data, swap);
    case PlyType::f32:
      return decoded<float>(data, swap);
    default:
      return decoded<double>(data, swap);
  }
}

PlyRows::PlyRows(const PlyFile& file, const PlyBlock& block)
    : file_(file),
      block_(block),
      watch_(file.source),
      is_text_(file.is_text()),
      swap_(file.swap()),
      rest_(file.bytes.read(block.begin, block.bytes, buffer_)),
      lines_(rest_) {
  std::string_view line;
  for (std::uint64_t i = 0; i < block.skipped; ++i) lines_.next_with_words(line, '\0');
}

void PlyRows::start_row() {
  watch_.step();
  if (!is_text_) return;
  std::string_view line;
  if (!lines_.next_with_words(line, '\0')) fail("the file ends before its last element");
  words_ = Words(line);
}

double PlyRows::next(PlyType type) {
  if (is_text_) {
    double value = 0;
    const std::string_view word = words_.next();
    if (word.empty()) fail("the line has too few values");
    if (!parse(word, value)) fail("'" + std::string(word.substr(0, 40)) + "' is not a number");
    return value;
  }
  const std::size_t size = size_of(type);
  if (rest_.size() < size) fail("the file ends before its last element");
  const double value = ply_value(rest_.data(), type, swap_);
  rest_.remove_prefix(size);
  return value;
}

void PlyRows::next_list(const PlyProperty& property, std::vector<double>& values) {
  const double length = next(property.length);
  const std::uint64_t behind = file_.bytes.size() - block_.begin - block_.bytes;
  const std::uint64_t room =
      is_text_ ? file_.bytes.size() : (rest_.size() + behind) / size_of(property.value);
  if (!(length >= 0) || length != std::floor(length) || length > static_cast<double>(room)) {
    fail("a list is longer than the file");
  }
  values.clear();
  for (double i = 0; i < length; ++i) {
    watch_.step();
    values.push_back(next(property.value));
  }
}

void PlyRows::end_row() {
  if (is_text_ && !words_.next().empty()) fail("the line has too many values");
}

void PlyRows::fail(const std::string& what) const {
  if (is_text_) {
    file_.source.fail("line " + std::to_string(block_.line - 1 + lines_.number()), what);
  }
  file_.source.fail("byte " + std::to_string(block_.begin + block_.bytes - rest_.size()), what);
}

}  // namespace delray::scenes::internal
