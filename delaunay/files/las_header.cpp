// Reads the header of LAS 1.0 to 1.4 (ASPRS), which LAZ files have too, and finds records behind
// it.
#include "delaunay/files/las_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace delray::delaunay {
namespace {

constexpr std::array kFormats = {
    LasPointFormat{20, 0, 15, 0x1f},  LasPointFormat{28, 0, 15, 0x1f},
    LasPointFormat{26, 20, 15, 0x1f}, LasPointFormat{34, 28, 15, 0x1f},
    LasPointFormat{57, 0, 15, 0x1f},  LasPointFormat{63, 28, 15, 0x1f},
    LasPointFormat{30, 0, 16, 0xff},  LasPointFormat{36, 30, 16, 0xff},
    LasPointFormat{38, 30, 16, 0xff}, LasPointFormat{59, 0, 16, 0xff},
    LasPointFormat{67, 30, 16, 0xff},
};

template <class T>
T load(std::string_view content, std::size_t byte) {
  T value;
  std::memcpy(&value, content.data() + byte, sizeof value);
  return value;
}

}  // namespace

LasHeader parse_las_header(const ByteSource& source) {
  constexpr std::size_t kSmallest = 227, kSmallest14 = 375;
  std::string buffer;
  const std::string_view content =
      source.read(0, std::min<std::uint64_t>(kSmallest14, source.size()), buffer);
  const Input input = source.input();
  if (!content.starts_with("LASF")) fail(input, at_byte(0), "does not begin with \"LASF\"");
  if (content.size() < kSmallest) fail(input, at_byte(content.size()), "the header is cut off");
  const int major = load<std::uint8_t>(content, 24), minor = load<std::uint8_t>(content, 25);
  if (major != 1 || minor > 4) {
    fail(
        input, at_byte(24),
        "LAS version " + std::to_string(major) + "." + std::to_string(minor) + " is not supported");
  }
  // The uppermost bit tells of LAZ; the next one did in its first years.
  constexpr unsigned kCompressed = 128, kCompressedOnce = 64;
  const unsigned type = load<std::uint8_t>(content, 104);
  const unsigned number = type & ~(kCompressed | kCompressedOnce);
  if (number >= kFormats.size()) {
    fail(input, at_byte(104), "unknown point format " + std::to_string(number));
  }
  LasHeader header;
  header.minor = static_cast<unsigned>(minor);
  header.format_number = number;
  header.format = kFormats[number];
  header.compressed = type != number;
  header.points_begin = load<std::uint32_t>(content, 96);
  header.record_size = load<std::uint16_t>(content, 105);
  header.count = load<std::uint32_t>(content, 107);
  if (minor == 4) {
    if (content.size() < kSmallest14) fail(input, at_byte(content.size()), "the header is cut off");
    if (const auto count = load<std::uint64_t>(content, 247); count != 0) header.count = count;
    header.extended_begin = load<std::uint64_t>(content, 235);
    header.extended_count = load<std::uint32_t>(content, 243);
  }
  for (int k = 0; k < 3; ++k) {
    header.scale[k] = load<double>(content, 131 + 8 * k);
    header.offset[k] = load<double>(content, 155 + 8 * k);
    if (!std::isfinite(header.scale[k]) || !std::isfinite(header.offset[k])) {
      fail(input, at_byte(131 + 8 * k), "scale or offset is not a finite number");
    }
  }
  const std::size_t smallest = minor == 4 ? kSmallest14 : kSmallest;
  header.size = load<std::uint16_t>(content, 94);
  if (header.size < smallest) {
    fail(input, at_byte(94),
         "the header claims to have " + std::to_string(header.size) + " bytes, but takes " +
             std::to_string(smallest));
  }
  if (header.points_begin < header.size)
    fail(input, at_byte(96), "points cannot begin inside the header");
  if (header.record_size < header.format.size) {
    fail(input, at_byte(105), "records are too short for their point format");
  }
  if (header.points_begin > source.size() ||
      (!header.compressed &&
       header.count > (source.size() - header.points_begin) / header.record_size)) {
    fail(input, at_byte(107),
         "the header announces " + std::to_string(header.count) +
             " points, more than the file holds");
  }
  header.content = source.read(0, header.points_begin, buffer);
  return header;
}

std::string_view find_las_record(const LasHeader& header, std::string_view user, unsigned number) {
  constexpr std::size_t kUser = 2, kNumber = 18, kLength = 20, kSize = 54;  // of a record's head
  std::size_t byte = header.size;
  for (auto left = load<std::uint32_t>(header.content, 100); left > 0; --left) {
    if (byte + kSize > header.points_begin) break;
    const std::string_view record = std::string_view(header.content).substr(byte);
    const std::size_t length = load<std::uint16_t>(record, kLength);
    if (record.substr(kUser).starts_with(user) && load<std::uint16_t>(record, kNumber) == number) {
      return record.substr(kSize, length);
    }
    byte += kSize + length;
  }
  return {};
}

std::string find_extended_las_record(const ByteSource& source, const LasHeader& header,
                                     std::string_view user, unsigned number, std::uint64_t most) {
  constexpr std::size_t kUser = 2, kNumber = 18, kLength = 20, kSize = 60;  // of a record's head
  std::uint64_t byte = header.extended_begin;
  std::string buffer;
  for (std::uint64_t left = header.extended_count; left > 0; --left) {
    if (byte < header.points_begin || byte > source.size() || source.size() - byte < kSize) break;
    const std::string_view record = source.read(byte, kSize, buffer);
    const auto length = load<std::uint64_t>(record, kLength);
    byte += kSize;
    if (length > source.size() - byte) break;
    if (record.substr(kUser).starts_with(user) && load<std::uint16_t>(record, kNumber) == number) {
      return length > most ? std::string() : std::string(source.read(byte, length, buffer));
    }
    byte += length;
  }
  return {};
}

files::GeoKeys read_las_geo_keys(const ByteSource& source, const LasHeader& header) {
  constexpr std::string_view kUser = "LASF_Projection";
  constexpr unsigned kDirectory = 34735, kTexts = 34737, kWellKnownText = 2112;
  constexpr std::uint64_t kLongest = std::uint64_t{1} << 20;  // of a well-known text
  const std::string_view directory = find_las_record(header, kUser, kDirectory);
  std::vector<std::uint16_t> numbers(directory.size() / sizeof(std::uint16_t));
  files::GeoKeys keys;
  if (!numbers.empty()) {
    std::memcpy(numbers.data(), directory.data(), numbers.size() * sizeof(std::uint16_t));
    keys = files::parse_geo_keys(numbers, find_las_record(header, kUser, kTexts));
    if (keys.known) return keys;
  }
  const std::string_view text = find_las_record(header, kUser, kWellKnownText);
  files::GeoKeys told = text.empty() ? files::parse_well_known_text(find_extended_las_record(
                                           source, header, kUser, kWellKnownText, kLongest))
                                     : files::parse_well_known_text(text);
  return told;
}

}  // namespace delray::delaunay
